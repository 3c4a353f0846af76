#include "soft_grip_2d.h"

#include <Eigen/LU>
#include <algorithm>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector2f;

// As in three dimensions.
constexpr double kLeastRigidShare2d = 0.85;
constexpr double kMostPullOut2d = 0.2;  // of the patch's radius: there the rigid share is 1
constexpr double kMostKick2d =
    0.03;  // of it, that an impulse moves the patch in one substep against the body

Vector2d across(const Vector2d& r) { return {-r.y(), r.x()}; }

/// The body as one rigid thing.
struct WholeBody2d {
  double mass = 0, inertia = 0, angular_momentum = 0;
  Vector2d centre{0, 0}, velocity{0, 0};
  Vector2d turned{0,
                  0};  // sums of m r . x0 and of m x0 x r: cosine and sine of the body's turn, times a length

  WholeBody2d(const ppu::SoftBody<2>& body, const HeldRest<2>& held) {
    const auto masses = body.model().masses();
    const auto x = body.positions(), v = body.velocities();
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const double m = double{masses[i]};
      mass += m;
      centre += m * x[i].cast<double>();
      velocity += m * v[i].cast<double>();
    }
    SC_ASSERT(mass > 0, "a body of {} particles has a mass of {} kg", masses.size(), mass);
    centre /= mass;
    velocity /= mass;
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const double m = double{masses[i]};
      const Vector2d r = x[i].cast<double>() - centre;
      const Vector2d rest = held.positions[i].cast<double>();
      inertia += m * r.squaredNorm();
      angular_momentum += m * across(r).dot(v[i].cast<double>());
      turned += m * Vector2d(rest.dot(r), across(rest).dot(r));
    }
    // A body of no extent turns all the same.
    const double least =
        1e-3 * mass * double{body.model().lattice().spacing} * double{body.model().lattice().spacing};
    inertia = std::max(inertia, least);
  }

  /// What was so far from the centre at rest, turned as the body is.
  Vector2d turn(const Vector2d& rest) const {
    const double length = turned.norm();
    if (!(length > 0)) return rest;
    const Vector2d along = turned / length;
    return along.x() * rest + along.y() * across(rest);
  }
};

}  // namespace

SoftGrip2d::SoftGrip2d(ppu::SoftBody<2>& body, std::uint32_t particle)
    : body_(body), particle_(particle), patch_(body.model(), particle), rest_(body) {}

void SoftGrip2d::pull(const HandMotion<2>& hand, const Vector2f& gravity, float step) {
  SC_ASSERT(step > 0, "a substep of {} s", step);
  using Strength = HandStrength<2>;
  const double h = double{step}, most = h * Strength::most_acceleration(gravity),
               damped = Strength::damped_share(h);
  rest_.renew(body_);
  const WholeBody2d whole(body_, rest_);
  const Vector2d point = this->point().cast<double>(), arm = point - whole.centre;

  // What is left of its swinging about the hand.
  const Vector2d drag = Strength::limited(damped * (hand.velocity.cast<double>() - whole.velocity), most);
  const double slow_down = -damped * whole.angular_momentum / whole.inertia;
  const Vector2d velocity = body_.velocities()[particle_].cast<double>() + drag + slow_down * across(arm);

  const Vector2d arm_at_rest = rest_.positions[particle_].cast<double>() - rest_.centre;
  const double pulled_out = (arm - whole.turn(arm_at_rest)).norm() / (kMostPullOut2d * double{patch_.radius});
  double rigid = std::min(1.0, kLeastRigidShare2d + (1 - kLeastRigidShare2d) * pulled_out * pulled_out);
  const Vector2d change = Strength::wanted_velocity(hand, point) - velocity - h * gravity.cast<double>();
  const Matrix2d of_whole =
      Matrix2d::Identity() / whole.mass + across(arm) * across(arm).transpose() / whole.inertia;
  const Matrix2d response = (1 - rigid) / patch_.mass * Matrix2d::Identity() + rigid * of_whole;
  const Vector2d impulse = Strength::limited(response.inverse() * change, most * whole.mass);

  Vector2d patch = (1 - rigid) / patch_.mass * impulse;
  const double most_patch = kMostKick2d * double{patch_.radius} / h;
  if (const double kick = patch.norm(); kick > most_patch) {
    rigid = 1 - (1 - rigid) * most_patch / kick;
    patch *= most_patch / kick;
  }
  const Vector2d shift = drag + rigid / whole.mass * impulse;
  const double turn = slow_down + rigid * across(arm).dot(impulse) / whole.inertia;
  for (std::size_t i = 0; i < patch_.weights.size(); ++i) {
    const Vector2d r = body_.position(i).cast<double>() - whole.centre;
    const Vector2d dv = shift + turn * across(r) + double{patch_.weights[i]} * patch;
    body_.add_particle_velocity(i, dv.cast<float>());
  }
}

void SoftGrip2d::let_go(const Vector2f& velocity) {
  body_.add_velocity(
      HandStrength<2>::throw_aid(velocity.cast<double>(), WholeBody2d(body_, rest_).velocity).cast<float>());
}

}  // namespace softcell::demos
