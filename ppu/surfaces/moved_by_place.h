#pragma once
// Rigid bodies that the program moves by setting their place, not their velocity: doors, lifts, characters.
//
// Such a body is somewhere else when the next substep begins, and may already be in a soft body. Contacts see it move there within the
// substep, from where it was in the last one. What goes too far for that has not moved but been put elsewhere.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "softcell/base/assert.h"

namespace softcell::ppu {

/// A place and an orientation.
struct Pose {
  Eigen::Vector3f position{0, 0, 0};  ///< metres
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();

  bool operator==(const Pose& other) const {
    return position == other.position && rotation == other.rotation;
  }
};

/// A motion that lasts a substep.
struct MovedByPlace {
  Pose from;
  Eigen::Vector3f velocity{0, 0, 0};  ///< m/s
  Eigen::Vector3f spin{0, 0, 0};      ///< rad/s
};

/// The motion from one pose to another one in `step` seconds. Nothing if the two are the same, or too far from each other: farther than
/// half of what the body measures, than 100 m/s take it, or turned by more than 60 degrees.
/// @param size  of the body along its longest axis, metres
inline std::optional<MovedByPlace> moved_by_place(const Pose& from, const Pose& to, float size, float step) {
  SC_ASSERT(step > 0 && size >= 0, "a body of {} m moves for {} s", size, step);
  constexpr float kFastest = 100, kLeastCosine = 0.5f;
  if (from == to) return std::nullopt;
  const Eigen::Vector3f way = to.position - from.position;
  const Eigen::Matrix3f turn = to.rotation * from.rotation.transpose();
  if (!(way.norm() <= std::min(size / 2, kFastest * step)) || (turn.trace() - 1) / 2 < kLeastCosine)
    return std::nullopt;
  const Eigen::Vector3f axis(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
  return MovedByPlace{from, way / step, axis / (2 * step)};
}

}  // namespace softcell::ppu
