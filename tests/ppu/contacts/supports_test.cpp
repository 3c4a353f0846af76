// Rigid bodies between soft ones and what they lie on.

#include "ppu/supports/supports.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "contact_world.h"
#include "ppu/supports/supported_set.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kHalf = 0.5f;  // of a crate, metres
constexpr float kCells = 0.1f;

/// A crate of 2 kg; it falls with the gravity of a substep.
ContactRigid crate(const Vector3f& centre) {
  ContactRigid rigid;
  rigid.centre = centre;
  rigid.velocity = {0, -9.81f * kStep, 0};
  rigid.inverse_mass = 0.5f;
  rigid.inverse_inertia = Vector3f(3, 4, 5).asDiagonal();
  return rigid;
}

/// Its corners, or those at x = kHalf only, on what is below.
std::vector<RigidTouch> corners_of(std::uint32_t crate, std::uint32_t on, const Vector3f& centre,
                                   bool all = true) {
  std::vector<RigidTouch> touches;
  for (const float x : {-kHalf, kHalf})
    for (const float z : {-kHalf, kHalf})
      if (all || x > 0)
        touches.push_back(
            {.a = crate, .b = on, .point = centre + Vector3f(x, -kHalf, z), .normal = {0, 1, 0}});
  return touches;
}

Press from_above(std::uint32_t rigid, const Vector3f& point) {
  return {.rigid = rigid,
          .point = point,
          .normal = {0, 1, 0},
          .mass = 1,
          .velocity = {0, -1, 0},
          .spacing = kCells};
}

TEST(Supports, ACrateOnItsCornersSlidesAndTurnsOnly) {
  std::vector<ContactRigid> rigids = {crate({0, kHalf, 0}), ContactRigid()};
  Supports supports;
  const std::vector<Press> presses = {from_above(0, {0.2f, 2 * kHalf, 0.1f})};
  const auto touches = corners_of(0, 1, rigids[0].centre);
  supports.hold(rigids, {.touches = touches}, presses, kStep);
  ASSERT_TRUE(rigids[0].held);
  EXPECT_NEAR(rigids[0].velocity.norm(), 0, 1e-5f) << "it stands";
  const Vector3f point(0.4f, 2 * kHalf, -0.3f);
  EXPECT_NEAR(rigids[0].mobility(point, {0, 1, 0}), 0, 1e-4f);
  EXPECT_NEAR(rigids[0].mobility({0, 0.1f, 0}, {1, 0, 0}), 0.5f, 1e-4f);
  // Half a metre beside its centre, it turns about the vertical axis, too.
  EXPECT_NEAR(rigids[0].mobility({0, kHalf, kHalf}, {1, 0, 0}), 0.5f + 4 * kHalf * kHalf, 1e-4f);
}

TEST(Supports, ACrateOnAnEdgeTipsOverIt) {
  std::vector<ContactRigid> rigids = {crate({0, kHalf, 0}), ContactRigid()};
  Supports supports;
  const std::vector<Press> presses = {from_above(0, {0.2f, 2 * kHalf, 0})};
  const auto touches = corners_of(0, 1, rigids[0].centre, false);
  supports.hold(rigids, {.touches = touches}, presses, kStep);
  ASSERT_TRUE(rigids[0].held);
  for (const float x : {-kHalf, 0.1f, kHalf}) {
    const float arm = x - kHalf, inertia = 1 / 5.0f + 2 * kHalf * kHalf;
    EXPECT_NEAR(rigids[0].mobility({x, 2 * kHalf, 0}, {0, 1, 0}), arm * arm / inertia, 1e-4f) << x;
  }
}

TEST(Supports, WhatIsLiftedOrTouchesNothingIsFree) {
  std::vector<ContactRigid> rigids = {crate({0, kHalf, 0}), ContactRigid(), crate({5, kHalf, 0})};
  Supports supports;
  Press from_below = from_above(0, {0, 0, 0});
  from_below.normal = {0, -1, 0}, from_below.velocity = {0, 10, 0};
  from_below.mass = 10;
  const std::vector<Press> presses = {from_below, from_above(2, {5, 2 * kHalf, 0})};
  const auto touches = corners_of(0, 1, rigids[0].centre);
  supports.hold(rigids, {.touches = touches}, presses, kStep);
  EXPECT_FALSE(rigids[0].held);
  EXPECT_FALSE(rigids[2].held);
  EXPECT_EQ(rigids[0].velocity.y(), -9.81f * kStep);
}

/// Two in the air, the lower one of which is in no contact with the soft body.
TEST(Supports, APairThatIsPressedKeepsItsMomentum) {
  for (const float impulse : {0.01f, 50.0f}) {
    std::vector<ContactRigid> rigids = {crate({0, 3 * kHalf, 0}), crate({0, kHalf, 0})};
    Supports supports;
    const Vector3f point(0.1f, 4 * kHalf, 0);
    const std::vector<Press> presses = {from_above(0, point)};
    const auto touches = corners_of(0, 1, rigids[0].centre);
    supports.hold(rigids, {.touches = touches}, presses, kStep);
    ASSERT_TRUE(rigids[0].held);
    EXPECT_NEAR(rigids[0].mobility(rigids[0].centre, {0, 1, 0}), 0.25f, 1e-4f) << "of both together";
    supports.add_impulse(0, point, {0, -impulse, 0});
    supports.release();
    EXPECT_FALSE(rigids[0].held);
    const Vector3f momentum = 2 * (rigids[0].velocity + rigids[1].velocity);
    const Vector3f expected(0, -impulse - 4 * 9.81f * kStep, 0);
    EXPECT_NEAR((momentum - expected).norm(), 0, 1e-5f * std::max(1.0f, impulse)) << impulse;
    EXPECT_NEAR(rigids[0].velocity.y(), rigids[1].velocity.y(), 0.01f * impulse) << "together";
  }
}

/// It slides by Coulomb's law, as long as that is no more than what soft bodies can have meant.
TEST(Supports, WhatIsPressedHarderThanFrictionHoldsSlides) {
  constexpr float kFriction = 0.5f;
  for (const float across : {0.1f, 0.9f, 100.0f}) {
    std::vector<ContactRigid> rigids = {crate({0, kHalf, 0}), ContactRigid()};
    auto touches = corners_of(0, 1, rigids[0].centre);
    for (RigidTouch& touch : touches) touch.friction = kFriction;
    Supports supports;
    const Vector3f point(0, 0, 0);
    const std::vector<Press> presses = {from_above(0, point)};
    supports.hold(rigids, {.touches = touches}, presses, kStep);
    EXPECT_NEAR(rigids[0].mobility({0.2f, 1, 0.3f}, {1, 0, 0}), 0, 1e-4f) << "it sticks";
    constexpr float kDown = 0.8f;
    supports.add_impulse(0, point, {across, -kDown, 0});
    supports.release();
    const float holds = kFriction * (kDown + 2 * 9.81f * kStep), slides = 0.5f * (across - holds);
    const bool is_within_reason = slides > 0 && slides < 0.1f * kCells / kStep;
    EXPECT_NEAR(rigids[0].velocity.x(), is_within_reason ? slides : 0, 2e-3f) << across;
    EXPECT_NEAR(rigids[0].velocity.y(), 0, 2e-3f) << across;
  }
}

/// Crates on a floor, one on top of the other, and a soft cube that falls on them.
struct CratesUnderACube {
  CratesUnderACube(float mass, int count, SolverFactory* solvers, float restitution = 0)
      : w({0, -9.81f, 0}, solvers) {
    w.add_floor(1, restitution);
    const float top = 0.3f * static_cast<float>(count);
    cube = &w.add(make_box({0.7f, 0.7f, 0.7f}, kCells), settings_of(kCells, 0.6f, 0.2f),
                  {0.03f, top + 0.5f, 0.02f});
    for (int i = 0; i < count; ++i)
      crates.push_back(&w.add(std::make_unique<btBoxShape>(btVector3(0.15f, 0.15f, 0.15f)),
                              mass * cube->model().mass(), {0, 0.15f + 0.3f * static_cast<float>(i), 0}, 0.6f,
                              restitution));
  }
  /// Metres, of the crates' corners and middles of edges and faces in the cube.
  float depth() const {
    const tests::DrawnBody drawn(*cube);
    float most = 0;
    for (const btRigidBody* crate : crates)
      for (const float x : {-0.15f, 0.0f, 0.15f})
        for (const float y : {-0.15f, 0.15f})
          for (const float z : {-0.15f, 0.0f, 0.15f})
            most = std::max(most, drawn.depth(to_eigen(crate->getWorldTransform() * btVector3(x, y, z))));
    return most;
  }
  ContactWorld w;
  SoftBody<3>* cube = nullptr;
  std::vector<btRigidBody*> crates;
};

/// Crates of a tenth of its mass were in the middle of the cube, three cells deep, for good.
TEST(LightBodies, ACrateCarriesAHeavyBody) {
  SpeRuntime spes;
  for (SolverFactory* const solvers :
       {static_cast<SolverFactory*>(nullptr), static_cast<SolverFactory*>(&spes)}) {
    for (const float mass : {1.0f, 0.1f, 0.03f}) {
      for (const int count : {1, 2}) {
        CratesUnderACube on(mass, count, solvers);
        float deepest = 0;
        for (int i = 0; i < 120; ++i) {
          on.w.run(1);
          deepest = std::max(deepest, on.depth());
        }
        EXPECT_LT(deepest, (count == 1 ? 0.25f : 0.7f) * kCells) << mass << ", " << count;
        EXPECT_LT(on.depth(), 0.1f * kCells) << mass << ", " << count << ", at rest";
      }
    }
  }
}

/// What one does to the other goes through it: it was half a cell deep in both for good.
TEST(LightBodies, APlateBetweenTwoBodiesStaysBetweenThem) {
  SpeRuntime spes;
  constexpr float kThick = 0.06f, kWide = 0.25f;
  for (SolverFactory* const solvers :
       {static_cast<SolverFactory*>(nullptr), static_cast<SolverFactory*>(&spes)}) {
    ContactWorld w({0, -9.81f, 0}, solvers);
    w.add_floor();
    const TriangleMesh cube = make_box({0.7f, 0.7f, 0.7f}, kCells);
    const SoftBody<3>& lower = w.add(cube, settings_of(kCells, 0.8f, 0.2f), {0, 0.36f, 0});
    const SoftBody<3>& upper = w.add(cube, settings_of(kCells, 0.8f, 0.2f), {0.03f, 1.3f, 0.02f});
    btRigidBody& plate = w.add(std::make_unique<btBoxShape>(btVector3(kWide, kThick / 2, kWide)),
                               0.03f * upper.model().mass(), {0, 0.75f, 0}, 0.6f);
    float deepest = 0;
    for (int i = 0; i < 180; ++i) {
      w.run(1);
      const tests::DrawnBody drawn_lower(lower), drawn_upper(upper);
      for (const float x : {-kWide, 0.0f, kWide})
        for (const float z : {-kWide, 0.0f, kWide})
          for (const float y : {-kThick / 2, kThick / 2}) {
            const Vector3f point = to_eigen(plate.getWorldTransform() * btVector3(x, y, z));
            deepest = std::max({deepest, drawn_lower.depth(point), drawn_upper.depth(point)});
          }
    }
    EXPECT_LT(deepest, 0.15f * kCells);
    EXPECT_NEAR(plate.getWorldTransform().getOrigin().y(), 0.7f, 0.6f * kCells);
  }
}

/// Crates of a hundredth of a ball's mass to twice of it, many more than are solved together: none is thrown out.
TEST(LightBodies, AHeapOfCratesAndBodiesStaysCalm) {
  constexpr float kRoom = 0.8f;
  ContactWorld w;
  w.add_floor();
  for (const float side : {-1.0f, 1.0f}) {
    w.add(std::make_unique<btBoxShape>(btVector3(0.1f, 3, kRoom + 0.2f)), 0, {side * (kRoom + 0.1f), 3, 0});
    w.add(std::make_unique<btBoxShape>(btVector3(kRoom + 0.2f, 3, 0.1f)), 0, {0, 3, side * (kRoom + 0.1f)});
  }
  const TriangleMesh ball = make_sphere(0.25f, 10);
  std::vector<const SoftBody<3>*> balls;
  for (int i = 0; i < 6; ++i) {
    const float angle = 2.4f * static_cast<float>(i);
    balls.push_back(
        &w.add(ball, settings_of(kCells, 0.5f, 0.2f),
               {0.5f * std::cos(angle), 0.6f + 0.5f * static_cast<float>(i), 0.5f * std::sin(angle)}));
  }
  std::vector<btRigidBody*> crates;
  for (int i = 0; i < 60; ++i) {
    const float angle = 2.4f * static_cast<float>(i), far = 0.1f * static_cast<float>(i % 7);
    const float mass = balls[0]->model().mass() * (i % 3 == 0 ? 2 : i % 3 == 1 ? 0.1f : 0.01f);
    crates.push_back(
        &w.add(std::make_unique<btBoxShape>(btVector3(0.1f, 0.1f, 0.1f)), mass,
               {far * std::cos(angle), 0.15f + 0.06f * static_cast<float>(i), far * std::sin(angle)}, 0.6f));
  }
  float fastest = 0;
  for (int frame = 0; frame < 240; ++frame) {
    w.run(1);
    for (const btRigidBody* const crate : crates)
      fastest = std::max(fastest, float{crate->getLinearVelocity().length()});
  }
  EXPECT_LT(fastest, 12) << "from a height of 4 m things fall at 9 m/s";
  for (const SoftBody<3>* const soft : balls) EXPECT_LT(soft->centre_of_mass().norm(), 5);
}

/// Bullet would throw it back with half the velocity at which the cube has pressed it down.
TEST(LightBodies, ACrateThatBouncesIsNotThrownIntoTheBodyOnIt) {
  CratesUnderACube on(0.1f, 1, nullptr, 0.7f);
  float deepest = 0, highest = 0;
  for (int i = 0; i < 60; ++i) {
    on.w.run(1);
    deepest = std::max(deepest, on.depth());
    highest = std::max(highest, float{on.crates[0]->getWorldTransform().getOrigin().y()});
  }
  EXPECT_LT(deepest, 0.15f * kCells);
  EXPECT_LT(highest, 0.16f);
}

/// On a slope of ten degrees: it is the load that holds it by friction.
TEST(LightBodies, ALoadedCrateDoesNotSlide) {
  ContactWorld w({9.81f * 0.1736f, -9.81f * 0.9848f, 0});
  w.add_floor(0.6f);
  SoftBody<3>& cube =
      w.add(make_box({0.4f, 0.4f, 0.4f}, kCells), settings_of(kCells, 0.8f, 0.3f), {0, 0.51f, 0});
  btRigidBody& crate = w.add(std::make_unique<btBoxShape>(btVector3(0.3f, 0.15f, 0.3f)),
                             0.1f * cube.model().mass(), {0, 0.15f, 0}, 1);
  w.run(20);
  const float begin = crate.getWorldTransform().getOrigin().x();
  w.run(180);
  EXPECT_NEAR(crate.getWorldTransform().getOrigin().x(), begin, 0.02f);
  EXPECT_GT(ContactWorld::lowest_drawn(cube), 0.29f) << "it is carried";
}

}  // namespace
}  // namespace softcell::ppu
