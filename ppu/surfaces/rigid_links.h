#pragma once
// What rigid bodies lie on, and what joins them, as their engine knows it.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>

namespace softcell::ppu {

/// Where a rigid body touches another one, as their engine knows it.
struct RigidTouch {
  std::uint32_t a = 0, b = 0;  ///< indices of their ContactRigid; one of the two moves
  Eigen::Vector3f point{0, 0, 0};
  Eigen::Vector3f normal{0, 1, 0};  ///< from b to a, unit length
  float gap = 0;                    ///< metres; below 0: they are in each other
  float friction = 0;               ///< of the two together
};

/// What a joint keeps two rigid bodies from doing against each other, in one direction: a row of its Jacobian, as the bodies stand now.
struct JointRow {
  static constexpr std::uint32_t kWorld = ~0u;  ///< in the place of a body: the joint is to the world
  static constexpr float kNoLimit = std::numeric_limits<float>::infinity();
  /// Which part of its velocity and spin counts. An impulse of the row acts on it likewise.
  struct Share {
    Eigen::Vector3f linear{0, 0, 0};
    Eigen::Vector3f angular{0, 0, 0};  ///< metres, or 1 if nothing linear counts
  };
  std::uint32_t a = 0, b = kWorld;  ///< indices of their ContactRigid, or kWorld; one of the two moves
  Share of_a = {}, of_b = {};
  float target = 0;  ///< the sum of both shares that it makes for, m/s or rad/s
  /// How much of that it gives up for an impulse of 1, as a spring does: 1/kg, or 1/(kg m^2).
  float softness = 0;
  /// Its impulses in a substep: of what ends at a limit, or has a motor.
  float least = -kNoLimit, most = kNoLimit;
  bool is_watched = false;  ///< the program wants to know what it bears, so its engine must see that

  bool is_limited() const { return least != -kNoLimit || most != kNoLimit; }
};

/// What holds rigid bodies near soft ones, as their engine knows it.
struct RigidLinks {
  std::span<const RigidTouch> touches = {};
  std::span<const JointRow> joints = {};

  bool empty() const { return touches.empty() && joints.empty(); }
};

/// Couplings look for touches of rigid bodies near soft ones, of what these touch, and so on, up to so many bodies farther. Joints they follow
/// to their end.
inline constexpr int kFarthestTouch = 4;

}  // namespace softcell::ppu
