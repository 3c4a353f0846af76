#pragma once
// How a hand pulls a soft body at a point, in either dimension: by a patch, which gives, and never so hard that the body tears.

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "grip.h"
#include "hand_patch.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/soft_body.h"
#include "whole_body.h"

namespace softcell::demos {

/// The held point of a body: metres, m/s.
template <int Dimension>
struct HeldPoint {
  using Vector = Eigen::Vector<double, Dimension>;
  Vector position = Vector::Zero(), velocity = Vector::Zero(), at_rest = Vector::Zero();
  double patch_share = 1;  ///< the change of its velocity when each particle's velocity changes by its weight
};

/// Pulls a body by the patch around the point that a hand holds.
///
/// The body's mass limits the impulse J that moves the held point as the hand wants. J acts on the body in two ways:
///
///     patch:  dv_i = (1 - s) J w_i / sum m w        w falls from 1 at the point to 0 at the patch's rim
///     body:   dv_i = s (J / M + I^-1 (r x J) x r_i)  as if the body were rigid, which deforms nothing
///
/// The share s grows to 1 as the point leaves its place in the body: the patch is pulled out only so far.
///
/// One thread uses it. Allocates in the constructor, and when the body yields. Deterministic.
template <int Dimension>
class PatchGrip {
 public:
  using Vector = Eigen::Vector<double, Dimension>;
  using Matrix = Eigen::Matrix<double, Dimension, Dimension>;

  /// @param middle  a particle  @pre the body has it, and outlives this object
  PatchGrip(ppu::SoftBody<Dimension>& body, std::uint32_t middle)
      : body_(body), patch_(body.model(), middle), rest_(body) {}

  const HandPatch<Dimension>& patch() const { return patch_; }
  /// The present rest shape.
  const HeldRest<Dimension>& rest() {
    rest_.renew(body_);
    return rest_;
  }

  /// Does the work of Grip::pull() for a point of the body as it is now. @pre step > 0
  void pull(const HeldPoint<Dimension>& held, const HandMotion<Dimension>& hand,
            const Eigen::Vector<float, Dimension>& gravity, float step) {
    SC_ASSERT(step > 0, "a substep of {} s", step);
    const double h = double{step};
    const Whole whole(body_, rest());
    const Vector arm = held.position - whole.centre;

    // Damps the swinging about the hand.
    const double most = h * Strength::most_acceleration(gravity), damped = Strength::damped_share(h);
    const Vector drag =
        Strength::limited(damped * (hand.velocity.template cast<double>() - whole.velocity), most);
    const typename Whole::Turn slow_down = -damped * whole.mean_turn();
    const Vector velocity = held.velocity + drag + Whole::velocity_of(slow_down, arm);

    const Vector arm_at_rest = whole.turned(held.at_rest - rest_.centre, orientation_);
    const double pulled_out = (arm - arm_at_rest).norm() / (kMostPullOut * double{patch_.radius});
    double rigid = std::min(1.0, kLeastRigidShare + (1 - kLeastRigidShare) * pulled_out * pulled_out);
    const Vector change =
        Strength::wanted_velocity(hand, held.position) - velocity - h * gravity.template cast<double>();
    const Matrix response =
        (1 - rigid) * held.patch_share / patch_.mass * Matrix::Identity() + rigid * whole.response_at(arm);
    const Vector impulse = Strength::limited(response.inverse() * change, most * whole.mass);

    Vector kick_of_patch = (1 - rigid) / patch_.mass * impulse;
    const double most_of_patch = kMostKick * double{patch_.radius} / h;
    if (const double kick = kick_of_patch.norm(); kick > most_of_patch) {
      rigid = 1 - (1 - rigid) * most_of_patch / kick;
      kick_of_patch *= most_of_patch / kick;
    }
    const Vector shift = drag + rigid / whole.mass * impulse;
    const typename Whole::Turn turn = slow_down + whole.turn_by(rigid, arm, impulse);
    for (std::size_t i = 0; i < patch_.weights.size(); ++i) {
      const Vector r = body_.position(i).template cast<double>() - whole.centre;
      const Vector dv = shift + Whole::velocity_of(turn, r) + double{patch_.weights[i]} * kick_of_patch;
      body_.add_particle_velocity(i, dv.template cast<float>());
    }
  }

  /// Does the work of Grip::let_go().
  void let_go(const Eigen::Vector<float, Dimension>& velocity) {
    const Vector of_body = Whole(body_, rest()).velocity;
    body_.add_velocity(Strength::throw_aid(velocity.template cast<double>(), of_body).template cast<float>());
  }

 private:
  using Whole = WholeBody<Dimension>;
  using Strength = HandStrength<Dimension>;

  // The smallest tried value that turned no cells inside out on 16 bodies of 117 to 22,209 particles that just stand on the floor by
  // themselves. With a rigid share of 0.5, cells of three of them turn.
  static constexpr double kLeastRigidShare = 0.85;
  static constexpr double kMostPullOut = 0.2;  // of the patch's radius: at this distance the rigid share is 1
  // Of the patch's radius: how far an impulse may move the patch against the body in a substep.
  static constexpr double kMostKick = 0.03;

  ppu::SoftBody<Dimension>& body_;
  HandPatch<Dimension> patch_;
  HeldRest<Dimension> rest_;
  typename Whole::Orientation orientation_ = Whole::upright();
};

}  // namespace softcell::demos
