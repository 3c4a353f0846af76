// Rigid bodies heavier than the soft ones that they lie on or hit.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <tuple>
#include <vector>

#include "contact_world.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kCube = 0.15f;  // of the lattice, metres

/// Seconds that the box lies there: SOFTCELL_HEAVY_SECONDS, 600 where nobody waits.
int seconds_at_rest() {
  const char* const text = std::getenv("SOFTCELL_HEAVY_SECONDS");
  return text != nullptr ? std::atoi(text) : 20;
}

TEST(HeavyBody, OfTenTimesItsMassRestsOnASoftOneForGood) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  for (const float alpha : {0.5f, 1.0f}) {
    ContactWorld w;
    w.add_floor();
    const SoftBody<3>& body = w.add(make_box({5 * kCube, 2 * kCube, 5 * kCube}, kCube),
                                    settings_of(kCube, alpha, 0.3f), {0, kCube, 0});
    btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(2 * kCube, 0.2f, 2 * kCube)),
                             10 * body.model().mass(), {0, 2 * kCube + 0.21f, 0});
    const auto place = [&] { return to_eigen(box.getWorldTransform().getOrigin()); };
    w.run(20 * 60);
    const Vector3f at_rest = place();
    EXPECT_GT(at_rest.y() - 0.2f, 0.8f * kCube) << "it is carried, not let through, at alpha " << alpha;
    for (int second = 0; second < seconds_at_rest(); ++second) {
      w.run(60);
      ASSERT_NEAR(place().y(), at_rest.y(), 0.01f * kCube) << second << " s, at alpha " << alpha;
      ASSERT_LT((place() - at_rest).norm(), 0.05f * kCube) << second << " s, at alpha " << alpha;
    }
    EXPECT_LT(box.getLinearVelocity().length(), 0.001f);
    EXPECT_LT(ContactWorld::fastest(body), 0.01f);
  }
}

TEST(HeavyBody, OfTwiceItsMassIsStoppedByASoftWallAndMomentumIsKept) {
  constexpr float kSpeed = 6;
  ContactWorld w({0, 0, 0});
  const SoftBody<3>& wall =
      w.add(make_box({2 * kCube, 6 * kCube, 6 * kCube}, kCube), settings_of(kCube, 0.5f, 0.2f), {0, 0, 0});
  const float mass = 2 * wall.model().mass();
  btRigidBody& box =
      w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.2f, 0.2f)), mass, {-1, 0.05f, 0.02f});
  box.setLinearVelocity({kSpeed, 0, 0});
  const auto momentum = [&] {
    Vector3d sum = double{mass} * to_eigen(box.getLinearVelocity()).cast<double>();
    for (std::size_t i = 0; i < wall.velocities().size(); ++i)
      sum += double{wall.model().masses()[i]} * wall.velocities()[i].cast<double>();
    return sum;
  };
  for (int frame = 0; frame < 120; ++frame) {
    w.run(1);
    ASSERT_LT(box.getWorldTransform().getOrigin().x(), wall.centre_of_mass().x()) << "it is through";
    ASSERT_LT((momentum() - Vector3d(mass * kSpeed, 0, 0)).norm(), 1e-5 * double{mass} * kSpeed) << frame;
  }
  // Both move on together, or apart: the box has two thirds of the mass.
  EXPECT_LT(box.getLinearVelocity().x(), wall.linear_momentum().x() / wall.model().mass() + 0.01f);
  EXPECT_LT(box.getLinearVelocity().x(), 0.68f * kSpeed);
}

/// Bullet adds forces and torques later in its step, as it adds gravity.
TEST(HeavyBody, AForceBesideTheMiddlePressesWithItsMoment) {
  constexpr float kForce = 100, kBeside = 0.1f, kMass = 2;
  ContactWorld w;
  w.add_floor();
  const SoftBody<3>& cushion =
      w.add(make_box({0.8f, 0.4f, 0.8f}, 0.1f), settings_of(0.1f, 0.7f, 0.3f), {0, 0.21f, 0});
  btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.1f, 0.2f)), kMass, {0, 0.52f, 0});
  box.setActivationState(DISABLE_DEACTIVATION);
  std::vector<Contact> contacts;
  float pressing = 0, moment = 0;
  for (int i = 0; i < 1200; ++i) {
    box.applyForce({0, -kForce, 0}, {kBeside, 0, 0});
    w.world.stepSimulation(kStep, 0);
    w.world.clearForces();
    if (i < 1080) continue;
    contacts.clear();
    w.bodies.append_contacts(contacts);
    for (const Contact& contact : contacts) {
      if (contact.second.object != &box) continue;
      const float impulse = contact.impulse * std::abs(contact.normal.y());
      pressing += impulse;
      moment += impulse * (contact.position.x() - box.getWorldTransform().getOrigin().x());
    }
  }
  EXPECT_NEAR(pressing, kForce + kMass * 9.81f, 0.03f * kForce);  // in one second
  EXPECT_NEAR(moment, kBeside * kForce, 0.1f * kBeside * kForce);
  EXPECT_GT(box.getWorldTransform().getBasis()[1].y(), 0.9f) << "it lies flat";
  EXPECT_GT(cushion.centre_of_mass().y(), 0.1f);
}

/// Edges of the load stand in the surface of the body. How far was reckoned from where they would end, with an error that was another one in
/// each substep: loads trembled, and crept.
TEST(HeavyBody, ALoadOnASoftBodyComesToRest) {
  for (const auto& [load, damping_time, most] :
       {std::tuple(3.0f, 0.02f, 1.5e-5f), std::tuple(10.0f, 0.1f, 5e-5f)}) {
    ContactWorld w;
    w.add_floor();
    SoftBodySettings settings = settings_of(0.1f);
    settings.frequency = 12, settings.damping_time = damping_time;
    const SoftBody<3>& cushion = w.add(make_box({0.6f, 0.6f, 0.6f}, 0.1f), settings, {0, 0.31f, 0});
    btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.1f, 0.2f)), load, {0, 0.72f, 0});
    box.setActivationState(DISABLE_DEACTIVATION);
    w.run(600);
    float sum = 0;
    constexpr int kFrames = 300;
    for (int i = 0; i < kFrames; ++i) {
      w.run(1);
      sum += cushion.mean_speed() / kFrames;
    }
    EXPECT_LT(sum, most) << load << " kg";
  }
}

}  // namespace
}  // namespace softcell::ppu
