#pragma once
// The interface of a hand's hold on one body, soft or rigid, and the strength of hands.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>

#include "hand_patch.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/fracture.h"

namespace softcell::demos {

/// How a hand moves in one substep.
template <int Dimension>
struct HandMotion {
  using Vector = Eigen::Vector<float, Dimension>;
  Vector at = Vector::Zero();        ///< metres, at the substep's end
  Vector velocity = Vector::Zero();  ///< m/s
};

/// One thread uses it. The body that is held must outlive it.
/// @tparam Dimension  2 or 3
template <int Dimension>
class Grip {
 public:
  using Vector = Eigen::Vector<float, Dimension>;

  virtual ~Grip() = default;

  /// Where the held point of the body is now, metres.
  virtual Vector point() const = 0;

  /// Changes the body's velocities before a substep of `step` seconds so that the held point follows the hand.
  /// @param gravity  m/s^2, which the substep will add  @pre step > 0
  virtual void pull(const HandMotion<Dimension>& hand, const Vector& gravity, float step) = 0;

  /// The part of a soft body that it holds. None: it holds a rigid body.
  virtual std::optional<HeldPart<Dimension>> part() const { return std::nullopt; }
  /// Whether it holds the soft body at this address.
  virtual bool holds(const void* /*body*/) const { return false; }
  /// Call it when bodies have broken, in this order. @return the grip on the piece that has the held part, null if that has vanished; none:
  /// this grip stays as it is
  virtual std::optional<std::unique_ptr<Grip>> follow(
      std::span<const ppu::BrokenBody<Dimension>> /*broken*/) const {
    return std::nullopt;
  }

  /// Changes the body's velocities when the hand throws it: see HandStrength::throw_aid(). @param velocity  of the hand, m/s
  virtual void let_go(const Vector& velocity) = 0;
};

/// The strength of a hand that holds a body. It grows with the body's mass: a hand can lift every body, and tears none.
template <int Dimension>
struct HandStrength {
  using Vector = Eigen::Vector<double, Dimension>;

  /// The time constant with which the held point approaches the hand.
  static constexpr double kReachSeconds = 0.05;
  static constexpr double kMostSpeed = 20;      ///< m/s
  static constexpr double kSwingSeconds = 0.1;  ///< time constant with which the held body stops swinging

  /// The largest acceleration that it can give a body, m/s^2. @param gravity  m/s^2
  static double most_acceleration(const Eigen::Vector<float, Dimension>& gravity) {
    return 40 + 2 * double{gravity.norm()};
  }

  /// The fraction of the swinging that it removes in a substep of `step` seconds.
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

  /// The change of velocity that brings a thrown body to the hand's velocity if it nearly has it already: the body still swings and
  /// wobbles.
  /// @param velocity, of_body  of the hand and of the body's centre, m/s
  static Vector throw_aid(const Vector& velocity, const Vector& of_body) {
    constexpr double kMost = 0.3;  // of the hand's velocity: a body that something holds back is not torn off
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
