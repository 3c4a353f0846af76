// What matching takes off momenta comes back.

#include "ppu/bodies/lost_momenta.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "free_flight.h"
#include "lattices_2d.h"
#include "soft_body_scenes.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::ppu {
namespace {

/// Particles anywhere, and velocities that a solver changes by a ten-thousandth.
template <int kDimension>
struct Cloud {
  using Vector = Eigen::Vector<float, kDimension>;
  using Double = Eigen::Vector<double, kDimension>;

  explicit Cloud(std::size_t count, float far = 0) {
    for (std::size_t i = 0; i < count; ++i) {
      positions.push_back(vector(1) + Vector::Constant(far));
      masses.push_back(0.5f + std::abs(number()));
      before.push_back(vector(2));
      after.push_back(before[i] + vector(2e-4f) + Vector::Constant(1e-4f));
    }
  }
  float number() { return std::uniform_real_distribution<float>(-1, 1)(random); }
  Vector vector(float size) {
    Vector v;
    for (int d = 0; d < kDimension; ++d) v[d] = size * number();
    return v;
  }
  /// The momenta of `after` less those of `before`.
  test::Momenta<kDimension> change() const {
    test::Momenta<kDimension> sums;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Double d = double{masses[i]} * (after[i] - before[i]).template cast<double>();
      sums.linear += d;
      sums.angular += turning::cross(Double(positions[i].template cast<double>()), d);
    }
    return sums;
  }

  std::mt19937 random{7};
  std::vector<Vector> positions, before, after;
  std::vector<float> masses;
};

/// The solver changes nothing in the steps before the last one.
template <int kDimension>
void expect_all_comes_back(Cloud<kDimension> cloud, double tolerance) {
  const test::Momenta<kDimension> lost = cloud.change();
  LostMomenta<kDimension> momenta;
  auto unchanged = cloud.before;
  for (int step = 1; step < LostMomenta<kDimension>::kSteps; ++step)
    momenta.count(cloud.positions, cloud.masses, cloud.before, unchanged);
  EXPECT_EQ(unchanged, cloud.before);
  momenta.count(cloud.positions, cloud.masses, cloud.before, cloud.after);
  const test::Momenta<kDimension> left = cloud.change();
  EXPECT_LT((left.linear).norm(), tolerance * lost.linear.norm());
  EXPECT_LT(test::size_of(left.angular), tolerance * test::size_of(lost.angular));
}

TEST(LostMomenta, ComeBackAsARigidMotion) {
  // Floats of 2 m/s have steps of 1.2e-7; 0.01 kg m/s are lost per particle.
  for (const std::size_t count : {4u, 33u, 1000u}) {
    expect_all_comes_back<3>(Cloud<3>(count), 2e-3);
    expect_all_comes_back<2>(Cloud<2>(count), 2e-3);
  }
}

TEST(LostMomenta, ComeBackFarFromTheOrigin) {
  expect_all_comes_back<3>(Cloud<3>(100, 1000), 2e-3);
  expect_all_comes_back<2>(Cloud<2>(100, 1000), 2e-3);
}

TEST(LostMomenta, OfParticlesOnALineOnlyMomentumComesBack) {
  Cloud<3> cloud(20);
  for (auto& position : cloud.positions) position = {position.x(), 0, 0};
  const Eigen::Vector3d lost = cloud.change().linear;
  LostMomenta<3> momenta;
  for (int step = 0; step < LostMomenta<3>::kSteps; ++step) {
    if (step > 0) cloud.before = cloud.after;
    momenta.count(cloud.positions, cloud.masses, cloud.before, cloud.after);
  }
  EXPECT_LT((cloud.change().linear + lost).norm(), 2e-3 * lost.norm());
}

TEST(LostMomenta, WhatFloatsCannotHoldIsGivenBackLater) {
  // A hundredth of what a float of 1 m/s can tell, a thousand times.
  const std::vector<Eigen::Vector2f> positions = {{-1, 0}, {1, 0}, {0, 1}};
  const std::vector<float> masses = {1e-6f, 1, 1};
  std::vector<Eigen::Vector2f> velocities(3, Eigen::Vector2f(1, 1));
  LostMomenta<2> momenta;
  for (int step = 0; step < 1000; ++step) {
    std::vector<Eigen::Vector2f> after = velocities;
    after[0].y() -= 1.2e-3f;  // 1.2e-9 kg m/s
    momenta.count(positions, masses, velocities, after);
    velocities[1] = after[1], velocities[2] = after[2];
  }
  const float given = velocities[1].y() + velocities[2].y() - 2;
  EXPECT_NEAR(given, 1.2e-6f, 2.5e-7f);
}

TEST(LostMomenta, ForgetWhatIsNotFinite) {
  Cloud<3> cloud(10);
  LostMomenta<3> momenta;
  auto after = cloud.after;
  after[3].x() = std::numeric_limits<float>::infinity();
  momenta.count(cloud.positions, cloud.masses, cloud.before, after);
  for (int step = 0; step < 2 * LostMomenta<3>::kSteps; ++step) {
    after = cloud.before;
    momenta.count(cloud.positions, cloud.masses, cloud.before, after);
    EXPECT_EQ(after, cloud.before);
  }
}

TEST(LostMomenta, OfAWholeAreThoseOfItsPieces) {
  const Cloud<3> cloud(30, 5);
  LostMomenta<3> whole;
  auto after = cloud.after;
  whole.count(cloud.positions, cloud.masses, cloud.before, after);
  // Particles 0 to 11, and the others.
  const std::span<const Eigen::Vector3f> x = cloud.positions;
  const std::span<const float> m = cloud.masses;
  const auto mass_and_centre = [&](std::size_t first, std::size_t end) {
    double mass = 0;
    Eigen::Vector3d centre(0, 0, 0);
    for (std::size_t i = first; i < end; ++i) mass += m[i], centre += double{m[i]} * x[i].cast<double>();
    return std::pair(mass, Eigen::Vector3d(centre / mass));
  };
  const auto [mass, centre] = mass_and_centre(0, 30);
  Cloud<3> given = cloud;
  given.after = cloud.before;
  for (const auto& [first, end] :
       {std::pair(std::size_t{0}, std::size_t{12}), {std::size_t{12}, std::size_t{30}}}) {
    const auto of_piece = mass_and_centre(first, end);
    LostMomenta<3> piece;
    piece.inherit(whole, of_piece.first / mass, of_piece.second - centre);
    const std::size_t count = end - first;
    const std::span<Eigen::Vector3f> changed = std::span(given.after).subspan(first, count);
    for (int step = 1; step < LostMomenta<3>::kSteps; ++step)
      piece.count(x.subspan(first, count), m.subspan(first, count), changed, changed);
  }
  const test::Momenta<3> lost = cloud.change(), back = given.change();
  EXPECT_LT((lost.linear + back.linear).norm(), 2e-3 * lost.linear.norm());
  EXPECT_LT((lost.angular + back.angular).norm(), 2e-3 * lost.angular.norm());
}

SoftBodySettings soft_rubber() {
  return {.cell_size = 0.1f, .half_width = 2, .density = 200, .alpha = 0.5f, .damping = 0.1f};
}

TEST(LostMomenta, ABodyInFlightKeepsItsMomentaOnThePpu) {
  PpuSolver<3> solver;
  SoftBody<3> block(block_model({5, 4, 3}, soft_rubber()), {3, 2, 1});
  test::throw_body(block);
  test::expect_momenta_stay(solver, block);
  SoftBody<3> penguin(make_soft_body_model(make_penguin(0.9f), soft_rubber()));
  test::throw_body(penguin);
  test::expect_momenta_stay(solver, penguin);
  PpuSolver<2> flat;
  SoftBody<2> man(make_soft_body_model(test::man132(), soft_rubber()), {1, 2});
  test::throw_body(man);
  test::expect_momenta_stay(flat, man);
}

TEST(LostMomenta, AreNothingAfterATeleport) {
  SoftBody<3> body(block_model({5, 4, 3}, soft_rubber())), other = body;
  for (SoftBody<3>* const each : {&body, &other}) each->add_angular_velocity({0, 3, 1});
  body.pull(1.0f / 120);
  const SoftBody<3> pulled = body;
  // Two bodies in one state, of which one has come by a way on which it lost nothing.
  other = SoftBody<3>(pulled.shared_model());
  for (std::size_t i = 0; i < pulled.model().particles(); ++i)
    other.set_particle(i, pulled.position(i), pulled.velocities()[i]);
  body.translate({0, 0, 0});
  body.move_without_force(Eigen::Quaternionf::Identity(), {0, 0, 0});
  other.move_without_force(Eigen::Quaternionf::Identity(), {0, 0, 0});
  for (int step = 0; step < LostMomenta<3>::kSteps; ++step) {
    body.pull(1.0f / 120);
    other.pull(1.0f / 120);
  }
  for (std::size_t i = 0; i < pulled.model().particles(); ++i)
    EXPECT_EQ(body.velocities()[i], other.velocities()[i]);
}

}  // namespace
}  // namespace softcell::ppu
