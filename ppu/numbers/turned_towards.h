#pragma once
// A rotation on the way from one to another.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "ppu/numbers/deterministic_math.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

/// Goes a share of the shorter way: interpolates the quaternions linearly, and normalises the result.
/// @param share  0: `from`, 1: `to`
/// @pre both are unit quaternions, except for what a program's own rounding adds up to
inline Eigen::Quaternionf turned_towards(const Eigen::Quaternionf& from, const Eigen::Quaternionf& to,
                                         float share) {
  // Rotations of rigid bodies come from the program's engine, and one that is no number is not softcell's mistake.
  SC_ASSERT(!(std::abs(from.norm() - 1) > 0.1f) && !(std::abs(to.norm() - 1) > 0.1f),
            "rotations of length {} and {}", from.norm(), to.norm());
  const float way = from.dot(to) < 0 ? -1.0f : 1.0f;
  Eigen::Quaternionf between;
  between.coeffs() = from.coeffs() + share * (way * to.coeffs() - from.coeffs());
  return between.normalized();
}

/// The same for an angle in radians, which may be many turns.
inline float turned_towards(float from, float to, float share) {
  return share < 1 ? from + share * (to - from) : to;
}

/// The rotation by an angle in radians, counter-clockwise above 0; the same bits on every host.
inline Eigen::Matrix2f rotation_matrix(float angle) {
  const auto s = static_cast<float>(sine(double{angle})), c = static_cast<float>(cosine(double{angle}));
  Eigen::Matrix2f rotation;
  rotation << c, -s, s, c;
  return rotation;
}

}  // namespace softcell::ppu
