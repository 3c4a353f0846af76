// Soft bodies that are welded as a whole, or nearly: what lies on them, falls on them and hits them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "attached_world.h"

namespace softcell::ppu::attached {
namespace {

class WeldedPads : public SolvedByBoth {};
INSTANTIATE_TEST_SUITE_P(SolvedBy, WeldedPads, kBothSolvers, SolvedByBoth::name);

/// A block whose particles are all welded, as a table.
struct Table {
  SoftBody<3>& body;
  AttachmentId weld;
  explicit Table(AttachedWorld& w, const AttachmentSettings<3>& settings = {})
      : body(w.add(block({0.6f, 0.3f, 0.6f}), stiff(), {0, 1, 0})),
        weld(w.bodies.attach(body, all_of(body), settings)) {}
};

std::unique_ptr<btCollisionShape> crate() {
  return std::make_unique<btBoxShape>(btVector3(0.1f, 0.1f, 0.1f));
}

/// What presses on particles that are held meets what holds them, however light they are.
TEST_P(WeldedPads, WhatIsWeldedAsAWholeCarriesARigidBody) {
  for (const float mass : {2.0f, 100.0f}) {
    SCOPED_TRACE(mass);
    AttachedWorld w(GetParam());
    const Table table(w);
    const btRigidBody& load = w.add(crate(), mass, {0, 1.26f, 0});
    w.run(120);
    const float settled = height_of(load);
    EXPECT_NEAR(settled, 1.25f, 0.05f * kCell);
    w.run(240);
    EXPECT_NEAR(height_of(load), settled, 0.01f * kCell);
    const auto state = w.bodies.attachment(table.weld);
    ASSERT_TRUE(state);
    const float weight = 9.81f * (mass + table.body.model().mass());
    EXPECT_NEAR(state->force.y(), weight, 0.02f * weight);
  }
}

/// Bullet hands the weight of the upper ones down after softcell has solved the contacts.
TEST_P(WeldedPads, WhatIsWeldedAsAWholeCarriesAStack) {
  AttachedWorld w(GetParam());
  const Table table(w);
  std::vector<btRigidBody*> stack;
  for (int k = 0; k < 4; ++k)
    stack.push_back(&w.add(crate(), 20, {0, 1.251f + 0.2f * static_cast<float>(k), 0}));
  w.run(300);
  const float settled = height_of(*stack[0]);
  EXPECT_GT(settled, 1.25f - 0.15f * kCell);
  w.run(300);
  EXPECT_NEAR(height_of(*stack[0]), settled, 0.02f * kCell);
  EXPECT_GT(height_of(*stack[3]), settled + 0.55f) << "it stands";
}

TEST_P(WeldedPads, WhatIsWeldedAsAWholeLiftsARigidBody) {
  AttachedWorld w(GetParam());
  const Table table(w);
  const btRigidBody& load = w.add(crate(), 50, {0, 1.25f, 0});
  w.run(30);
  const float up = 0.5f;  // m/s
  w.bodies.move_attachment(table.weld, Vector3f(0, 1 + 2 * up, 0), Eigen::Quaternionf::Identity(), 2);
  w.run(120);
  EXPECT_NEAR(height_of(load), 1.25f + 2 * up, 0.05f * kCell);
}

TEST_P(WeldedPads, WhatIsWeldedAsAWholeStopsWhatFallsOnIt) {
  AttachedWorld w(GetParam());
  const Table table(w);
  const btRigidBody& load = w.add(crate(), 100, {0, 2.25f, 0});
  float lowest = 10;
  for (int frame = 0; frame < 120; ++frame) {
    w.run(1);
    lowest = std::min(lowest, height_of(load));
  }
  EXPECT_GT(lowest, 1.25f - 0.1f * kCell);
}

TEST_P(WeldedPads, WhatIsWeldedAsAWholeGivesBackAsAWallDoes) {
  AttachedWorld w(GetParam());
  const Table table(w);
  constexpr float kRestitution = 0.8f, kHeight = 0.8f;
  SoftBodySettings settings = stiff();
  settings.restitution = kRestitution;
  table.body.set_material(settings);
  btRigidBody& ball = w.add(std::make_unique<btSphereShape>(0.1f), 20, {0, 1.25f + kHeight, 0});
  ball.setRestitution(1);
  const int down = static_cast<int>(60 * std::sqrt(2 * kHeight / 9.81f));
  w.run(down + 5);
  float highest = 0;
  for (int frame = 0; frame < 40; ++frame) {
    w.run(1);
    highest = std::max(highest, height_of(ball) - 1.25f);
  }
  EXPECT_NEAR(highest, kRestitution * kRestitution * kHeight, 0.05f * kHeight);
}

TEST_P(WeldedPads, WhatIsWeldedAsAWholeBreaksOffUnderWhatItCannotCarry) {
  for (const bool holds : {true, false}) {
    AttachedWorld w(GetParam());
    const Table table(w, {.break_force = holds ? 4000.0f : 500.0f});
    const btRigidBody& load = w.add(crate(), 100, {0, 1.2505f, 0});
    w.run(60);
    EXPECT_EQ(height_of(load) > 1.2f, holds) << height_of(load);
    EXPECT_EQ(w.bodies.attachment(table.weld).has_value(), holds);
  }
}

/// The rigid body was stopped as by a wall, and the block kept all that its weld did not carry: it flew off at 60 times the speed.
TEST_P(WeldedPads, WhatBreaksOffFliesNoFasterThanWhatHitsIt) {
  constexpr float kSpeed = 10;
  for (const float force : {50.0f, 2000.0f, 1e5f}) {
    SCOPED_TRACE(force);
    AttachedWorld w(GetParam(), {0, 0, 0});
    SoftBodySettings light = stiff();
    light.density = 50;
    SoftBody<3>& sign = w.add(block({0.2f, 0.2f, 0.2f}), light, {0, 0, 0});
    const AttachmentId weld = w.bodies.attach(sign, all_of(sign), {.break_force = force});
    btRigidBody& car = w.add(std::make_unique<btBoxShape>(btVector3(0.3f, 0.3f, 0.3f)), 100, {0, 0, -1});
    car.setLinearVelocity({0, 0, kSpeed});
    float fastest = 0;
    for (int frame = 0; frame < 30; ++frame) {
      w.run(1);
      fastest = std::max(fastest, sign.mean_speed());
    }
    EXPECT_FALSE(w.bodies.attachment(weld));
    EXPECT_LT(fastest, 1.5f * kSpeed);
    EXPECT_GT(car.getLinearVelocity().z(), 0.7f * kSpeed);
  }
}

/// The particles are held, and the floor holds the crate: an impulse between the two has no limit.
TEST_P(WeldedPads, WhatIsWeldedAsAWholeGivesWayToACrateOnTheGround) {
  AttachedWorld w(GetParam());
  w.add(std::make_unique<btBoxShape>(btVector3(5, 0.5f, 5)), 0, {0, -0.5f, 0});
  const btRigidBody& load = w.add(crate(), 1, {0, 0.1f, 0});
  SoftBodySettings light = stiff();
  light.density = 50;
  SoftBody<3>& pad = w.add(block({0.2f, 0.2f, 0.2f}), light, {0, 0.32f, 0});
  const AttachmentId weld = w.bodies.attach(pad, all_of(pad));
  w.run(30);
  w.bodies.move_attachment(weld, Vector3f(0, 0.25f, 0), Eigen::Quaternionf::Identity(), 0.5f);
  for (int frame = 0; frame < 60; ++frame) {
    w.run(1);
    ASSERT_LT(ContactWorld::fastest(pad), 2) << "m/s, after frame " << frame;
    ASSERT_LT(load.getLinearVelocity().length(), 1) << "m/s, after frame " << frame;
  }
  EXPECT_NEAR(height_of(load), 0.1f, 0.02f);
}

/// As a whole the strip is held fast, and hit as a wall that moves as fast as its end: a ball of a hundred times its mass left with the
/// end's speed.
TEST_P(WeldedPads, AnEndThatSwingsHitsWithItsOwnMass) {
  for (const float mass : {1.0f, 100.0f}) {
    SCOPED_TRACE(mass);
    AttachedWorld w(GetParam(), {0, 0, 0});
    SoftBodySettings settings = stiff();
    settings.restitution = 0.9f;
    SoftBody<3>& strip = w.add(block({1, 0.2f, 0.2f}), settings, {0, 0, 0});
    w.bodies.attach(strip, Patch<3>::of_particles(
                               particles_where(strip, [](const Vector3f& p) { return p.x() < -0.45f; })));
    double energy = 0;
    for (std::uint32_t i = 0; i < strip.model().particles(); ++i) {
      const Vector3f velocity(0, 0, strip.position(i).x() > 0 ? 4.0f : 0.0f);
      strip.add_particle_velocity(i, velocity);
      energy += 0.5 * double{strip.model().masses()[i]} * double{velocity.squaredNorm()};
    }
    btRigidBody& ball =
        w.add(std::make_unique<btSphereShape>(0.1f), mass * strip.model().mass(), {0.4f, 0, 0.25f});
    ball.setRestitution(1);
    float fastest = 0;
    for (int frame = 0; frame < 60; ++frame) {
      w.run(1);
      fastest = std::max(fastest, ball.getLinearVelocity().length());
    }
    EXPECT_GT(fastest, 0) << "it is hit";
    EXPECT_LT(0.5 / double{ball.getInvMass()} * double{fastest} * double{fastest}, energy);
  }
}

TEST_P(WeldedPads, WhatSleepsOnAPadWakesWhenThePadIsLetGoOrMoved) {
  for (const bool let_go : {true, false}) {
    SCOPED_TRACE(let_go);
    AttachedWorld w(GetParam());
    const Table table(w);
    const btRigidBody& load = w.add(crate(), 3, {0, 1.25f, 0});
    w.bodies.let_sleep(SleepSettings{.seconds = 0.5f});
    for (int frame = 0; frame < 600 && (load.isActive() || !table.body.asleep()); ++frame) w.run(1);
    ASSERT_FALSE(load.isActive());
    if (let_go)
      w.bodies.detach(table.weld);
    else
      w.bodies.move_attachment(table.weld, Vector3f(0, 0.5f, 0), Eigen::Quaternionf::Identity(), 1);
    w.run(90);
    EXPECT_LT(height_of(load), 0.8f);
  }
}

}  // namespace
}  // namespace softcell::ppu::attached
