#pragma once
// Treats a soft body that a hand holds as one rigid body: how it moves, and what an impulse does to it. It computes in double precision and
// sums in the order of particles.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "hand_patch.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// Dimension: 2 or 3. SI units; a turn is an angular velocity in rad/s, in two dimensions counter-clockwise.
template <int Dimension>
struct WholeBody;

template <>
struct WholeBody<3> {
  using Vector = Eigen::Vector3d;
  using Turn = Eigen::Vector3d;
  using Orientation = Eigen::Quaterniond;
  static Orientation upright() { return Orientation::Identity(); }

  WholeBody(const ppu::SoftBody<3>& body, const HeldRest<3>& rest);

  /// The velocity that a turn gives to a point at `r` from the centre.
  static Vector velocity_of(const Turn& turn, const Vector& r) { return turn.cross(r); }
  Turn mean_turn() const { return inverse_inertia * angular_momentum; }
  /// The turn that `share` of an impulse (N s) at `r` from the centre causes.
  Turn turn_by(double share, const Vector& r, const Vector& impulse) const {
    return share * (inverse_inertia * r.cross(impulse));
  }
  /// Maps an impulse of 1 N s at `r`, by its direction, to the change of velocity there.
  Eigen::Matrix3d response_at(const Vector& r) const;
  /// The vector from the centre at rest, rotated as the body is. @param orientation  the result of the last call, where the search begins
  Vector turned(const Vector& from_centre_at_rest, Orientation& orientation) const;

  double mass = 0;
  Vector centre{0, 0, 0}, velocity{0, 0, 0}, angular_momentum{0, 0, 0};
  Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();  ///< sum m (x - c) x0^T
};

template <>
struct WholeBody<2> {
  using Vector = Eigen::Vector2d;
  using Turn = double;
  struct Orientation {};  // needs no start value
  static Orientation upright() { return {}; }

  WholeBody(const ppu::SoftBody<2>& body, const HeldRest<2>& rest);

  static Vector velocity_of(Turn turn, const Vector& r) { return turn * across(r); }
  Turn mean_turn() const { return angular_momentum / inertia; }
  Turn turn_by(double share, const Vector& r, const Vector& impulse) const {
    return share * across(r).dot(impulse) / inertia;
  }
  Eigen::Matrix2d response_at(const Vector& r) const {
    return Eigen::Matrix2d::Identity() / mass + across(r) * across(r).transpose() / inertia;
  }
  Vector turned(const Vector& from_centre_at_rest, Orientation& orientation) const;

  double mass = 0, inertia = 0, angular_momentum = 0;
  Vector centre{0, 0}, velocity{0, 0};
  /// Sums of m x0 . r and of m x0 x r: cosine and sine of the body's rotation, times a common factor.
  Vector correlation{0, 0};

 private:
  static Vector across(const Vector& r) { return {-r.y(), r.x()}; }
};

}  // namespace softcell::demos
