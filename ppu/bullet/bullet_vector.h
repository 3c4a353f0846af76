#pragma once
// Converts Bullet's vectors and matrices to Eigen's and back.

#include <LinearMath/btMatrix3x3.h>
#include <LinearMath/btVector3.h>

#include <Eigen/Core>

namespace softcell::ppu {

inline btVector3 to_bullet(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Vector3f to_eigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Matrix3f to_eigen(const btMatrix3x3& matrix) {
  Eigen::Matrix3f result;
  for (int row = 0; row < 3; ++row) result.row(row) = to_eigen(matrix[row]).transpose();
  return result;
}

}  // namespace softcell::ppu
