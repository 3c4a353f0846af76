#pragma once
// A soft body that turns, flies and trembles with nothing around it.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "ppu/numbers/turning.h"
#include "softcell/soft_bodies/soft_body.h"
#include "softcell/soft_bodies/soft_body_solver.h"

namespace softcell::ppu::test {

template <int kDimension>
struct Momenta {
  using Vector = Eigen::Vector<double, kDimension>;
  Vector linear = Vector::Zero();  ///< kg m/s
  /// kg m^2/s, about the centre of mass
  turning::Axial<kDimension> angular = turning::cross(linear, linear);
};

template <int kDimension>
Momenta<kDimension> momenta_of(const SoftBody<kDimension>& body) {
  using Vector = typename Momenta<kDimension>::Vector;
  Momenta<kDimension> momenta;
  Vector centre = Vector::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < body.model().particles(); ++i) {
    const double m = body.model().masses()[i];
    mass += m, centre += m * body.position(i).template cast<double>();
    momenta.linear += m * body.velocities()[i].template cast<double>();
  }
  centre /= mass;
  for (std::size_t i = 0; i < body.model().particles(); ++i)
    momenta.angular +=
        body.model().masses()[i] * turning::cross(Vector(body.position(i).template cast<double>() - centre),
                                                  Vector(body.velocities()[i].template cast<double>()));
  return momenta;
}
inline double size_of(double spin) { return std::abs(spin); }
inline double size_of(const Eigen::Vector3d& spin) { return spin.norm(); }

/// Lets a body fly, turn and tremble.
template <int kDimension>
void throw_body(SoftBody<kDimension>& body) {
  using Vector = typename SoftBody<kDimension>::Vector;
  Vector velocity = Vector::Zero();
  velocity.x() = 0.7f, velocity.y() = -0.4f;
  body.add_velocity(velocity);
  if constexpr (kDimension == 3)
    body.add_angular_velocity({0.3f, 2, 1});
  else
    body.add_angular_velocity(2);
  for (std::size_t i = 0; i < body.model().particles(); ++i) {
    velocity = Vector::Zero();
    velocity.y() = 0.5f * std::sin(5 * body.position(i).x());
    body.add_particle_velocity(i, velocity);
  }
}

/// Steps a body 1,000 times: 1e-5 of its momentum and of its angular momentum are the most that it may lose.
template <int kDimension>
void expect_momenta_stay(SoftBodySolver<kDimension>& solver, SoftBody<kDimension>& body) {
  constexpr float kStep = 1.0f / 120;
  const Momenta<kDimension> before = momenta_of(body);
  SoftBody<kDimension>* const bodies[] = {&body};
  for (int step = 0; step < 1000; ++step) {
    solver.kick(bodies, kStep);
    solver.finish();
    for (std::size_t i = 0; i < body.model().particles(); ++i)
      body.set_particle(i, body.position(i) + kStep * body.velocities()[i], body.velocities()[i]);
  }
  const Momenta<kDimension> after = momenta_of(body);
  EXPECT_LT((after.linear - before.linear).norm(), 1e-5 * before.linear.norm());
  EXPECT_LT(size_of(after.angular - before.angular), 1e-5 * size_of(before.angular));
}

}  // namespace softcell::ppu::test
