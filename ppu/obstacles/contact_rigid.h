#pragma once
// Rigid bodies as contacts see them.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

namespace softcell::ppu {

/// How impulses change the velocity of a rigid body that is not free: it lies on another body or is joined to one, which takes up a part of
/// each impulse. A symmetric matrix of 6 x 6.
struct HeldMobility {
  Eigen::Matrix3f linear;    ///< 1/kg: of velocity, by an impulse
  Eigen::Matrix3f coupling;  ///< 1/(kg m): of velocity, by a moment; transposed: of spin, by an impulse
  Eigen::Matrix3f angular;   ///< 1/(kg m^2): of spin, by a moment
};

/// A rigid body in the world's frame.
struct ContactRigid {
  std::uint32_t number = 0;           ///< the same in every substep
  Eigen::Vector3f centre{0, 0, 0};    ///< of mass, metres
  Eigen::Vector3f velocity{0, 0, 0};  ///< m/s, of the centre: what it would have without contacts
  Eigen::Vector3f spin{0, 0, 0};      ///< rad/s
  float inverse_mass = 0;             ///< 1/kg; 0: nothing moves it
  Eigen::Matrix3f inverse_inertia = Eigen::Matrix3f::Zero();  ///< 1/(kg m^2)
  float friction = 0.5f;
  /// Has a value if the engine lets the body move along some axes only, or if what it lies on holds it (supports.h). None: it is free.
  std::optional<HeldMobility> held = {};

  Eigen::Vector3f velocity_at(const Eigen::Vector3f& point) const {
    return velocity + spin.cross(Eigen::Vector3f(point - centre));
  }

  struct Change {
    Eigen::Vector3f velocity, spin;
  };
  /// Effective inverse mass at a point in a direction, 1/kg.
  float mobility(const Eigen::Vector3f& point, const Eigen::Vector3f& direction) const {
    if (inverse_mass == 0) return 0;
    const Eigen::Vector3f arm = point - centre;
    const Eigen::Vector3f turn = arm.cross(direction);
    if (!held) return inverse_mass + turn.dot(inverse_inertia * turn);
    const Change change = change_by(direction, turn);
    return direction.dot(change.velocity) + turn.dot(change.spin);
  }
  /// The change by an impulse, kg m/s, and a moment about the centre, kg m^2/s.
  Change change_by(const Eigen::Vector3f& impulse, const Eigen::Vector3f& moment) const {
    if (!held) return {inverse_mass * impulse, inverse_inertia * moment};
    return {held->linear * impulse + held->coupling * moment,
            held->coupling.transpose() * impulse + held->angular * moment};
  }
};

}  // namespace softcell::ppu
