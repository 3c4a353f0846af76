#pragma once
// A rotation on the way from one to another.

#include <Eigen/Geometry>

namespace softcell::ppu {

/// Goes a share of the shorter way: interpolates the quaternions linearly, and normalises the result.
/// @param share  0: `from`, 1: `to`
/// @pre both are unit quaternions
inline Eigen::Quaternionf turned_towards(const Eigen::Quaternionf& from, const Eigen::Quaternionf& to,
                                         float share) {
  const float way = from.dot(to) < 0 ? -1.0f : 1.0f;
  Eigen::Quaternionf between;
  between.coeffs() = from.coeffs() + share * (way * to.coeffs() - from.coeffs());
  return between.normalized();
}

}  // namespace softcell::ppu
