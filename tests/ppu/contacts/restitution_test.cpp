// Restitution of contacts of what is drawn, against formulas.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "contact_world.h"
#include "softcell/soft_bodies/state_hash.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr float kCellSize = 0.1f;

SoftBodySettings stiff(float restitution) {
  SoftBodySettings settings = settings_of(kCellSize, 1, 0.3f);
  settings.half_width = 4;
  settings.restitution = restitution;
  return settings;
}

/// How high the lowest drawn point of a body comes after it has fallen from `height` and bounced once, metres.
float height_of_bounce(const TriangleMesh& mesh, const SoftBodySettings& settings, float height,
                       float floor_restitution, SolverFactory* solvers = nullptr) {
  ContactWorld w({0, -9.81f, 0}, solvers);
  w.add_floor(1, floor_restitution);
  SoftBody<3>& body = w.add(mesh, settings, {0, 0, 0});
  body.translate({0, height - ContactWorld::lowest_drawn(body), 0});
  float highest = 0;
  bool has_hit = false;
  for (int i = 0; i < 240; ++i) {
    const float before = body.linear_momentum().y();
    w.run(1);
    if (body.linear_momentum().y() > before) {
      if (has_hit) break;  // again
      has_hit = true;
    }
    if (has_hit) highest = std::max(highest, ContactWorld::lowest_drawn(body));
  }
  EXPECT_TRUE(has_hit);
  return highest;
}

TEST(Restitution, GivesBackItsSquareOfTheHeight) {
  const TriangleMesh box = make_box({0.5f, 0.4f, 0.5f}, kCellSize), ball = make_sphere(0.34f, 12);
  for (const TriangleMesh* mesh : {&box, &ball})
    for (const float e : {0.3f, 0.5f, 0.8f, 1.0f})
      for (const float height : {1.0f, 1.37f, 2.2f}) {
        const float expected = e * e * height;
        EXPECT_NEAR(height_of_bounce(*mesh, stiff(e), height, 1), expected, 0.05f * expected)
            << "restitution " << e << ", from " << height << " m, " << mesh->positions.size() << " vertices";
      }
}

TEST(Restitution, IsThatOfTheWholeBodyHoweverSoft) {
  SoftBodySettings soft = stiff(0.6f);
  soft.alpha = 0.1f;
  soft.half_width = 1;
  const float height = height_of_bounce(make_sphere(0.34f, 12), soft, 1.5f, 1);
  EXPECT_NEAR(height, 0.36f * 1.5f, 0.05f * 0.36f * 1.5f);
}

TEST(Restitution, IsTheProductOfBothBodies) {
  const float height = height_of_bounce(make_sphere(0.34f, 12), stiff(0.8f), 1.5f, 0.75f);
  EXPECT_NEAR(height, 0.36f * 1.5f, 0.05f * 0.36f * 1.5f);
  EXPECT_LT(height_of_bounce(make_box({0.5f, 0.4f, 0.5f}, kCellSize), stiff(0.9f), 1.5f, 0), 0.3f);
}

TEST(Restitution, OnSpesTheSameHeight) {
  SpeRuntime spes({.spes = 2});
  const float height = height_of_bounce(make_sphere(0.34f, 12), stiff(0.7f), 1.5f, 1, &spes);
  EXPECT_NEAR(height, 0.49f * 1.5f, 0.05f * 0.49f * 1.5f);
}

/// Two equal bodies that meet on one line leave with the speed of their approach times e, momenta kept.
TEST(Restitution, OfTwoSoftBodies) {
  SpeRuntime spes({.spes = 2});
  for (SolverFactory* const solvers :
       {static_cast<SolverFactory*>(nullptr), static_cast<SolverFactory*>(&spes)}) {
    ContactWorld w({0, 0, 0}, solvers);
    const auto model = make_soft_body_model(make_sphere(0.34f, 12), stiff(0.9f));
    SoftBody<3>& left = w.bodies.add(model, {-0.6f, 0, 0});
    SoftBody<3>& right = w.bodies.add(model, {0.6f, 0.1f, 0});
    left.add_velocity({3, 0, 0});
    right.add_velocity({-1, 0.2f, 0});
    const auto momenta = [&] {
      Eigen::Vector<double, 6> sum = Eigen::Vector<double, 6>::Zero();
      for (const SoftBody<3>* body : {&left, &right})
        for (std::size_t i = 0; i < model->particles(); ++i) {
          const Eigen::Vector3d p = double{model->masses()[i]} * body->velocities()[i].cast<double>();
          sum.head<3>() += p;
          sum.tail<3>() += body->position(i).cast<double>().cross(p);
        }
      return sum;
    };
    const auto energy = [&] {
      double sum = 0;
      for (const SoftBody<3>* body : {&left, &right})
        for (std::size_t i = 0; i < model->particles(); ++i)
          sum += 0.5 * double{model->masses()[i]} * double{body->velocities()[i].squaredNorm()};
      return sum;
    };
    const auto before = momenta();
    const double energy_before = energy();
    // Along the line between their middles.
    Vector3f apart = Vector3f::Zero();
    float approach = 0;
    for (int i = 0; i < 40; ++i) {
      const Vector3f line = (right.centre_of_mass() - left.centre_of_mass()).normalized();
      const float along =
          line.dot(Vector3f(right.linear_momentum() - left.linear_momentum())) / model->mass();
      if (along < 0) approach = -along, apart = line;
      w.run(1);
    }
    const float leaves =
        apart.dot(Vector3f(right.linear_momentum() - left.linear_momentum())) / model->mass();
    EXPECT_NEAR(leaves, 0.81f * approach, 0.04f * approach);
    EXPECT_LT((momenta() - before).norm(), 1e-4 * before.norm());
    EXPECT_LT(energy(), 1.0001 * energy_before);
  }
}

TEST(Restitution, ARigidBallBouncesOffASoftWall) {
  ContactWorld w({0, 0, 0});
  SoftBody<3>& wall = w.add(make_box({0.4f, 1.2f, 1.2f}, kCellSize), stiff(0.8f), {0, 0, 0});
  btRigidBody& ball = w.add(std::make_unique<btSphereShape>(0.2f), 5, {-1, 0.02f, 0.03f}, 1, 1);
  ball.setLinearVelocity({4, 0, 0});
  w.run(60);
  Eigen::Vector3d momentum = 5 * to_eigen(ball.getLinearVelocity()).cast<double>();
  for (std::size_t i = 0; i < wall.velocities().size(); ++i)
    momentum += double{wall.model().masses()[i]} * wall.velocities()[i].cast<double>();
  EXPECT_LT((momentum - Eigen::Vector3d(20, 0, 0)).norm(),
            5e-5 * 20);  // of which most is matching's rounding
  const float leaves = wall.linear_momentum().x() / wall.model().mass() - ball.getLinearVelocity().x();
  EXPECT_NEAR(leaves, 0.8f * 4, 0.05f * 0.8f * 4);
}

/// It touches before it turns back.
TEST(Restitution, BouncesFromWhereItTouches) {
  for (const float speed : {3.0f, 20.0f}) {
    ContactWorld w({0, 0, 0});
    w.add_floor(0, 1);
    SoftBody<3>& body = w.add(make_box({0.5f, 0.4f, 0.5f}, kCellSize), stiff(1), {0, 2, 0});
    body.add_velocity({0, -speed, 0});
    // From 1.8 m down to the floor, and back to where it comes in 2.5 m / speed in all.
    const float seconds = 2.5f / speed;
    const int substeps = static_cast<int>(std::lround(seconds * 120));
    for (int i = 0; i < substeps; ++i) w.world.stepSimulation(1.0f / 120, 0);
    const float way = speed * static_cast<float>(substeps) / 120 - 1.8f;
    EXPECT_NEAR(ContactWorld::lowest_drawn(body), way, 0.02f) << speed;
  }
}

TEST(Restitution, WhatRestsDoesNotJitter) {
  for (const float e : {0.5f, 1.0f}) {
    ContactWorld w;
    w.add_floor(1, 1);
    const SoftBody<3>& body = w.add(make_box({0.5f, 0.4f, 0.5f}, kCellSize), stiff(e), {0, 0.2f, 0});
    w.run(120);
    for (int i = 0; i < 60; ++i) {
      w.run(1);
      EXPECT_LT(ContactWorld::fastest(body), 0.001f) << e;
    }
  }
}

/// Two boxes on each other swing for a while, but not because they bounce.
TEST(Restitution, AStackIsNoMoreRestlessThanWithoutIt) {
  for (const float e : {0.0f, 0.5f, 0.8f, 1.0f}) {
    ContactWorld w;
    w.add_floor(1, 1);
    SoftBodySettings settings = stiff(e);
    settings.damping = 0.1f;
    const auto model = make_soft_body_model(make_box({0.5f, 0.4f, 0.5f}, kCellSize), settings);
    const SoftBody<3>& lower = w.bodies.add(model, {0, 0.2f, 0});
    const SoftBody<3>& upper = w.bodies.add(model, {0.05f, 0.605f, 0});
    w.run(180);
    const float height = upper.centre_of_mass().y();
    for (int i = 0; i < 60; ++i) {
      w.run(1);
      EXPECT_LT(ContactWorld::fastest(lower), 0.06f) << e;
      EXPECT_LT(ContactWorld::fastest(upper), 0.12f) << e;
    }
    EXPECT_NEAR(upper.centre_of_mass().y(), height, 0.05f * kCellSize) << e;
  }
}

/// A body that spins about x and falls is driven along z by friction while it bounces.
TEST(Restitution, FrictionTurnsSpinIntoWay) {
  ContactWorld w;
  w.add_floor(1, 1);
  SoftBody<3>& ball = w.add(make_sphere(0.34f, 16), stiff(0.8f), {0, 1, 0});
  ball.add_angular_velocity({10, 0, 0});
  w.run(60);
  EXPECT_GT(ball.linear_momentum().z() / ball.model().mass(), 0.3f);
}

/// Without a restitution of both there is none, to the last bit.
/// A cube or a bar that turns, 40 kg.
class Turning : public testing::TestWithParam<int> {
 protected:
  SoftBody<3>& add(ContactWorld& w, const Vector3f& centre, const Vector3f& velocity) {
    SoftBodySettings settings = settings_of(kCellSize, any(0.1f, 1), 0.05f);
    settings.restitution = 1;
    settings.friction = 1;
    const Vector3f size = GetParam() % 2 == 0 ? Vector3f(0.4f, 0.4f, 0.4f) : Vector3f(0.8f, 0.3f, 0.3f);
    SoftBody<3>& body = w.add(make_box(size, kCellSize), settings, centre);
    const Eigen::Quaternionf turned =
        Eigen::Quaternionf(any(-1, 1), any(-1, 1), any(-1, 1), any(-1, 1)).normalized();
    const Vector3f spin(any(-8, 8), any(-8, 8), any(-8, 8));
    for (std::size_t p = 0; p < body.positions().size(); ++p) {
      const Vector3f arm = turned * (body.position(p) - centre);
      body.set_particle(p, centre + arm, velocity + spin.cross(arm));
    }
    return body;
  }
  float any(float least, float most) { return std::uniform_real_distribution<float>(least, most)(random_); }

  /// Kinetic and potential, joules.
  static double energy_of(const SoftBody<3>& body, float gravity) {
    double energy = 0;
    for (std::size_t p = 0; p < body.positions().size(); ++p) {
      const double mass = double{body.model().masses()[p]};
      energy +=
          mass * (double{body.velocities()[p].squaredNorm()} / 2 + double{gravity * body.position(p).y()});
    }
    return energy;
  }
  /// @return  the most energy of five seconds, as a share of that at the beginning
  template <typename Energy>
  static double most_of(ContactWorld& w, const Energy& energy) {
    const double begin = energy();
    double most = begin;
    for (int i = 0; i < 300; ++i) {
      w.run(1);
      most = std::max(most, energy());
    }
    return most / begin;
  }

 private:
  std::mt19937 random_{static_cast<unsigned>(GetParam())};
};

INSTANTIATE_TEST_SUITE_P(Restitution, Turning, testing::Range(0, 10));

TEST_P(Turning, OnAFloorGainNoEnergy) {
  ContactWorld w;
  w.add_floor(any(0.3f, 1), 1);
  const SoftBody<3>& body = add(w, {0, any(0.8f, 1.5f), 0}, {any(-2, 2), any(-3, 0), any(-2, 2)});
  EXPECT_LT(most_of(w, [&] { return energy_of(body, 9.81f); }), 1.03);
}

TEST_P(Turning, AgainstEachOtherGainNoEnergy) {
  ContactWorld w(Vector3f::Zero());
  const SoftBody<3>&a = add(w, {0, 0, 0}, {any(1, 4), 0, 0}),
        &b = add(w, {0.9f, any(-0.2f, 0.2f), 0}, {0, 0, 0});
  EXPECT_LT(most_of(w, [&] { return energy_of(a, 0) + energy_of(b, 0); }), 1.03);
}

TEST_P(Turning, AgainstARigidBoxGainNoEnergy) {
  ContactWorld w(Vector3f::Zero());
  btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.15f, 0.25f)), any(2, 60),
                           {0.9f, any(-0.2f, 0.2f), 0}, 1, 1);
  const SoftBody<3>& body = add(w, {0, 0, 0}, {any(1, 4), 0, 0});
  const auto energy_of_box = [&] {
    const btVector3 v = box.getLinearVelocity(), spin = box.getAngularVelocity();
    return double{v.length2() / box.getInvMass() / 2} +
           double{spin.dot(box.getInvInertiaTensorWorld().inverse() * spin) / 2};
  };
  EXPECT_LT(most_of(w, [&] { return energy_of(body, 0) + energy_of_box(); }), 1.03);
}

TEST(Restitution, OfZeroChangesNothing) {
  std::vector<std::uint64_t> hashes;
  for (const float of_floor : {0.0f, 1.0f}) {
    ContactWorld w;
    w.add_floor(1, of_floor);
    SoftBody<3>& body = w.add(make_sphere(0.34f, 12), stiff(0), {0, 1, 0});
    w.run(90);
    hashes.push_back(state_hash(body));
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

/// A cube above a floor, or a wire, that gives back everything.
SoftBody<3>& add_cube_above(bool wire, float restitution, ContactWorld& w) {
  if (wire)
    w.add(std::make_unique<btCapsuleShapeZ>(0.005f, 2), 0, {0, 0, 0}, 0, 1);
  else
    w.add_floor(0, 1);
  SoftBodySettings settings = settings_of(kCellSize, 0.9f, 0.1f);
  settings.restitution = restitution;
  return w.add(make_box({0.6f, 0.6f, 0.6f}, kCellSize), settings, {0, 1, 0});
}

/// An edge stops what does not bounce.
TEST(Restitution, IsThatOfAFloorOnEdgesToo) {
  for (const float e : {0.5f, 0.9f}) {
    std::vector<float> fastest;
    for (const bool wire : {false, true}) {
      ContactWorld w;
      const SoftBody<3>& body = add_cube_above(wire, e, w);
      fastest.push_back(0);
      for (int i = 0; i < 30; ++i) {
        w.run(1);
        fastest.back() = std::max(fastest.back(), body.linear_momentum().y() / body.model().mass());
      }
    }
    EXPECT_NEAR(fastest[1], fastest[0], 0.03f * fastest[0]) << e;
  }
}

/// What a bounce, or an edge, does to a body as a whole is an impulse of their contact as much as what contacts do to cells: events sum up to
/// the body's change of momentum. Bounces had no events at all.
TEST(Restitution, EventsHaveAllImpulses) {
  for (const bool wire : {false, true}) {
    for (const float e : {0.0f, 0.5f, 0.9f}) {
      ContactWorld w;
      const SoftBody<3>& body = add_cube_above(wire, e, w);
      w.bodies.watch_contacts(true);
      const int frames = wire ? 30 : 60;  // before it falls off the wire
      w.run(frames);
      float impulse = 0;
      const auto events = w.bodies.poll_contact_events();
      for (const ContactEvent& event : events) impulse += event.impulse * event.normal.y();
      const float fallen = 9.81f * static_cast<float>(frames) / 60 * body.model().mass();
      EXPECT_EQ(events.size(), 1u) << (wire ? "wire, " : "floor, ") << e;
      EXPECT_GT(impulse, 0.5f * fallen) << e;
      EXPECT_NEAR(impulse, body.linear_momentum().y() + fallen, (wire ? 0.1f : 0.02f) * fallen)
          << (wire ? "wire, " : "floor, ") << e;
    }
  }
}

}  // namespace
}  // namespace softcell::ppu
