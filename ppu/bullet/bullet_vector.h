#pragma once
// Between Bullet's vectors and Eigen's.

#include <LinearMath/btVector3.h>

#include <Eigen/Core>

namespace softcell::ppu {

inline btVector3 to_bullet(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Vector3f to_eigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace softcell::ppu
