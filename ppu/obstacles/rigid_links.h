#pragma once
// Contacts and joints between rigid bodies near soft ones, as their engine knows them.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>

namespace softcell::ppu {

/// A contact of two rigid bodies, as their engine knows it.
struct RigidTouch {
  std::uint32_t a = 0, b = 0;  ///< indices of their ContactRigid; at least one of the two moves
  Eigen::Vector3f point{0, 0, 0};
  Eigen::Vector3f normal{0, 1, 0};  ///< from b to a, unit length
  float gap = 0;                    ///< metres; below 0: they penetrate each other
  float friction = 0;               ///< of the two together
};

/// One direction in which a joint constrains two rigid bodies: a row of its Jacobian, at the bodies' present places.
struct JointRow {
  static constexpr std::uint32_t kWorld = ~0u;  ///< instead of a body: the joint is to the world
  static constexpr float kNoLimit = std::numeric_limits<float>::infinity();
  /// The row's factors for the velocity and the spin of one body. An impulse of the row acts on the body by the same factors.
  struct Share {
    Eigen::Vector3f linear{0, 0, 0};
    Eigen::Vector3f angular{0, 0, 0};  ///< metres, or 1 if `linear` is 0
  };
  std::uint32_t a = 0, b = kWorld;  ///< indices of their ContactRigid, or kWorld; at least one moves
  Share of_a = {}, of_b = {};
  float target = 0;  ///< the sum of both shares that the joint aims at, m/s or rad/s
  /// How much the sum misses the target for an impulse of 1, as with a spring: 1/kg, or 1/(kg m^2).
  float softness = 0;
  /// Limits of the row's impulse in a substep, for a joint that has a stop or a motor.
  float least = -kNoLimit, most = kNoLimit;
  bool is_watched = false;  ///< the program reads the joint's load, so the engine itself must carry it

  bool is_limited() const { return least != -kNoLimit || most != kNoLimit; }
};

/// Contacts and joints that hold rigid bodies near soft ones, as their engine knows them.
struct RigidLinks {
  std::span<const RigidTouch> touches = {};
  std::span<const JointRow> joints = {};

  bool empty() const { return touches.empty() && joints.empty(); }
};

/// Couplings collect contacts of the rigid bodies near soft ones, of the bodies that these touch, and so on, up to so many bodies farther.
/// They follow joints to the end.
inline constexpr int kFarthestTouch = 4;

}  // namespace softcell::ppu
