#pragma once
// A hand's hold on one body, soft or rigid, and how hard hands pull.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>

#include "hand_patch.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/fracture.h"

namespace softcell::demos {

/// What a hand does in one substep.
template <int Dimension>
struct HandMotion {
  using Vector = Eigen::Vector<float, Dimension>;
  Vector at = Vector::Zero();        ///< metres, at the substep's end
  Vector velocity = Vector::Zero();  ///< m/s
};

/// One thread uses it. The body that is held outlives it.
/// @tparam Dimension  2 or 3
template <int Dimension>
class Grip {
 public:
  using Vector = Eigen::Vector<float, Dimension>;

  virtual ~Grip() = default;

  /// Where the held point of the body is now, metres.
  virtual Vector point() const = 0;

  /// Changes the body's velocities before a substep of `step` seconds, so that the held point follows the hand.
  /// @param gravity  m/s^2, that the substep will add  @pre step > 0
  virtual void pull(const HandMotion<Dimension>& hand, const Vector& gravity, float step) = 0;

  /// What it holds of a soft body. None: it holds a rigid one.
  virtual std::optional<HeldPart<Dimension>> part() const { return std::nullopt; }
  /// Whether it holds this soft body, which may break. @param body  its address
  virtual bool holds(const void* /*body*/) const { return false; }
  /// Bodies have broken, in this order. @return the grip on the piece that has what is held, null if that has vanished; none: this one goes
  /// on as it is
  virtual std::optional<std::unique_ptr<Grip>> follow(
      std::span<const ppu::BrokenBody<Dimension>> /*broken*/) const {
    return std::nullopt;
  }

  /// Changes the body's velocities as it is thrown: see HandStrength::throw_aid(). @param velocity  the hand's, m/s
  virtual void let_go(const Vector& velocity) = 0;
};

/// The strength of a hand that holds a body. It grows with the body's mass: every body can be lifted, and none is torn.
template <int Dimension>
struct HandStrength {
  using Vector = Eigen::Vector<double, Dimension>;

  /// The time in which the held point makes up for its distance from the hand.
  static constexpr double kReachSeconds = 0.05;
  static constexpr double kMostSpeed = 20;      ///< m/s
  static constexpr double kSwingSeconds = 0.1;  ///< in which the swinging of what is held falls to 1/e

  /// m/s^2 that it can give a body. @param gravity  m/s^2
  static double most_acceleration(const Eigen::Vector<float, Dimension>& gravity) {
    return 40 + 2 * double{gravity.norm()};
  }

  /// The share of the swinging that it takes away in a substep of `step` seconds.
  static double damped_share(double step) {
    SC_ASSERT(step > 0, "a substep of {} s", step);
    return step < kSwingSeconds ? step / kSwingSeconds : 1;
  }

  /// The velocity that the held point should have at the substep's end, m/s.
  static Vector wanted_velocity(const HandMotion<Dimension>& hand, const Vector& point) {
    return limited(
        hand.velocity.template cast<double>() + (hand.at.template cast<double>() - point) / kReachSeconds,
        kMostSpeed);
  }

  /// What brings the body that is thrown to the hand's velocity, if it has nearly got it: it swings, and wobbles.
  /// @param velocity, of_body  the hand's and the one of the body's centre, m/s
  static Vector throw_aid(const Vector& velocity, const Vector& of_body) {
    constexpr double kMost = 0.3;  // of the hand's velocity: what something holds back is not torn off
    return limited(velocity - of_body, kMost * velocity.norm());
  }

  static Vector limited(const Vector& v, double most) {
    SC_ASSERT(most >= 0, "a vector is limited to {}", most);
    const double length = v.norm();
    if (length <= most) return v;
    return v * (most / length);
  }
};

}  // namespace softcell::demos
