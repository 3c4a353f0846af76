#include "softcell/box2d/box2d_soft_bodies.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "soft_body_2d_scenes.h"
#include "softcell/soft_bodies/skin_2d.h"
#include "softcell/soft_bodies/state_hash.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;

SoftBodySettings rubber(float cell_size = 0.25f) {
  return {.cell_size = cell_size, .half_width = 2, .density = 5, .alpha = 0.5f, .damping = 0.1f};
}

float lowest(const SoftBody<2>& body) {
  float y = std::numeric_limits<float>::infinity();
  for (const Vector2f& p : body.positions()) y = std::min(y, p.y());
  return y;
}

class Box2dCoupling : public testing::TestWithParam<ContactMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, Box2dCoupling,
                         testing::Values(ContactMethod::kSpheres, ContactMethod::kSurface), name_of_method);

TEST_P(Box2dCoupling, RestsOnAFloorInShape) {
  World2d world(9.81f, GetParam());
  world.add_box({0, -1}, {10, 1});
  SoftBodySettings settings = rubber();
  settings.damping = 0.3f;
  SoftBody<2>& body = world.soft.add(rectangle_model({6, 4}, settings), {0, 0.6f});
  world.run(8);  // it is elastic, and bounces for a while
  float fastest = 0;
  for (const Vector2f& v : body.velocities()) fastest = std::max(fastest, v.norm());
  EXPECT_LT(fastest, 0.005f);
  EXPECT_LT(body.deformation(), 0.04f);
  // What is drawn gives below its weight, circles do not.
  EXPECT_NEAR(lowest(body), body.model().contact_radius(),
              GetParam() == ContactMethod::kSpheres ? 0.02f : 0.05f);
}

/// Leaves large numbers where the frames of the functions that are called next will lie.
[[gnu::noinline]] void litter_the_stack() {
  std::array<volatile float, 4096> litter;
  for (volatile float& number : litter) number = 1e6f;
}

// b2Vec2's default constructor sets nothing, not even by empty braces: the centre was what lay on the stack.
TEST(Box2dCouplingOfCircles, TheCentreOfMassOfAParticleIsItsPosition) {
  World2d world;
  const std::shared_ptr<const SoftBodyModel<2>> model = rectangle_model({3, 3}, rubber());
  litter_the_stack();
  world.soft.add(model, {0, 10});
  for (const b2Body* particle = world.box2d.GetBodyList(); particle != nullptr;
       particle = particle->GetNext()) {
    EXPECT_EQ(particle->GetLocalCenter(), b2Vec2(0, 0));
    EXPECT_EQ(particle->GetInertia(), 0);
  }
}

TEST(Box2dSoftBodies, AWorldHasOneObjectOfThem) {
  b2World world({0, -9.81f}), other({0, -9.81f});
  auto bodies = std::make_unique<Box2dSoftBodies>(world);
  EXPECT_THROW(Box2dSoftBodies{world}, std::invalid_argument);
  EXPECT_NO_THROW(Box2dSoftBodies{other});
  bodies.reset();
  EXPECT_NO_THROW(Box2dSoftBodies{world});
}

TEST_P(Box2dCoupling, FallsAsEverythingFalls) {
  World2d world(9.81f, GetParam());
  SoftBody<2>& body = world.soft.add(rectangle_model({3, 3}, rubber()), {0, 10});
  const Vector2f begin = body.centre_of_mass();
  const int steps = 60;
  const float h = 1.0f / 120;
  for (int i = 0; i < steps; ++i) world.soft.step(h);
  // v += h g, x += h v: n (n + 1) / 2 times h^2 g.
  EXPECT_NEAR(begin.y() - body.centre_of_mass().y(), 9.81f * h * h * steps * (steps + 1) / 2, 2e-4f);
  EXPECT_LT(body.deformation(), 1e-4f);
}

TEST_P(Box2dCoupling, KeepsMomentumInCollisionsWithRigidBodies) {
  World2d world(0, GetParam());
  SoftBody<2>& body = world.soft.add(rectangle_model({4, 4}, rubber()), {0, 0});
  b2Body* const box = world.add_box({3, 0.5f}, {0.4f, 0.4f}, 4);
  box->SetLinearVelocity({-3, 0});
  const float before = box->GetMass() * -3;
  world.run(2);
  const float after = box->GetMass() * box->GetLinearVelocity().x + body.linear_momentum().x();
  EXPECT_NEAR(after, before, 1e-3f * std::abs(before));
  EXPECT_GT(box->GetLinearVelocity().x, -2) << "the box has met the body";
  EXPECT_LT(body.linear_momentum().x(), -0.5f) << "and pushed it";
}

/// The highest point of the body's centre between 0.6 s and 1.6 s: it falls for 0.5 s and comes back.
float bounces_to(float restitution) {
  World2d world;
  world.add_box({0, -1}, {10, 1});
  SoftBodySettings settings = rubber();
  settings.restitution = restitution;
  SoftBody<2>& body = world.soft.add(rectangle_model({4, 4}, settings), {0, 1.6f});
  world.run(0.6f);
  float highest = 0;
  for (int i = 0; i < 120; ++i) {
    world.soft.step(1.0f / 120);
    highest = std::max(highest, body.centre_of_mass().y());
  }
  return highest;
}

TEST(Box2dCouplingOfCircles, ItsParticlesHaveTheRestitutionOfTheMaterial) {
  EXPECT_GT(bounces_to(0.9f), bounces_to(0) + 0.05f);
}

TEST(Box2dCouplingOfCircles, MakesNoContactsWithinABody) {
  World2d world;
  world.soft.add(rectangle_model({5, 5}, rubber()), {0, 0});
  world.run(0.1f);
  EXPECT_EQ(world.box2d.GetContactCount(), 0);
}

TEST_P(Box2dCoupling, TwoBodiesStackOnEachOther) {
  World2d world(9.81f, GetParam());
  world.add_box({0, -1}, {10, 1});
  SoftBody<2>& under = world.soft.add(rectangle_model({6, 3}, rubber()), {0, 0.2f});
  SoftBody<2>& over = world.soft.add(rectangle_model({3, 3}, rubber()), {0, 1.6f});
  world.run(5);
  EXPECT_GT(lowest(over), under.centre_of_mass().y() + 0.25f);
  EXPECT_LT(over.deformation(), 0.1f);
}

TEST_P(Box2dCoupling, ComesBackToItsShapeAfterBeingThrown) {
  World2d world(9.81f, GetParam());
  world.add_box({0, -1}, {10, 1});
  world.add_box({-5, 5}, {1, 10});
  world.add_box({5, 5}, {1, 10});  // or it would bounce off the floor's end and fall for ever
  SoftBody<2>& body = world.soft.add(rectangle_model({4, 6}, rubber()), {0, 0.5f});
  body.add_velocity({-25, 5});
  float worst = 0;
  for (int i = 0; i < 2400; ++i) {
    world.soft.step(1.0f / 120);
    worst = std::max(worst, body.deformation());
  }
  EXPECT_GT(worst, 0.1f) << "it was hardly deformed";
  EXPECT_LT(body.deformation(), 0.03f);
}

struct Friction {
  float body, floor;
};
void PrintTo(const Friction& friction, std::ostream* out) {
  *out << friction.body << " on " << friction.floor;
}
class SlidingFriction2d : public testing::TestWithParam<Friction> {};

/// Box2D takes the geometric mean of the coefficients of what touches: a body that slides is slowed down by
/// that times g.
TEST_P(SlidingFriction2d, IsTheGeometricMeanOfBothCoefficients) {
  constexpr float kSpeed = 3, kSeconds = 0.25f, kGravity = 9.81f;
  const auto [of_body, of_floor] = GetParam();
  World2d world(kGravity);
  world.add_box({0, -1}, {10, 1})->GetFixtureList()->SetFriction(of_floor);
  SoftBodySettings settings = rubber();
  settings.damping = 0.3f;
  settings.friction = of_body;
  SoftBody<2>& body = world.soft.add(rectangle_model({6, 2}, settings), {-3, 0.13f});
  world.run(4);
  const float before = body.linear_momentum().x();
  body.add_velocity({kSpeed, 0});
  world.run(kSeconds);
  const float mass = std::accumulate(body.model().masses().begin(), body.model().masses().end(), 0.0f);
  const float slowed_by = kSpeed + (before - body.linear_momentum().x()) / mass;
  const float coefficient = slowed_by / (kGravity * kSeconds);
  EXPECT_NEAR(coefficient, std::sqrt(of_body * of_floor), 0.01f)
      << "the soft body's friction is " << of_body << ", the floor's " << of_floor;
}

INSTANTIATE_TEST_SUITE_P(Coefficients, SlidingFriction2d,
                         testing::Values(Friction{0, 1}, Friction{0.1f, 1}, Friction{0.3f, 1},
                                         Friction{0.9f, 1}, Friction{0.6f, 0.5f}, Friction{1, 0.25f}));

TEST_P(Box2dCoupling, TakesChangesBetweenSteps) {
  World2d world(0, GetParam());
  SoftBody<2>& body = world.soft.add(rectangle_model({2, 2}, rubber()), {0, 0});
  world.run(0.1f);
  body.translate({3, 4});
  body.add_particle_velocity(body.model().outer().front(), {1, 0});
  world.soft.step(1.0f / 120);
  EXPECT_NEAR(body.centre_of_mass().x(), 3, 0.01f);
  EXPECT_GT(body.linear_momentum().x(), 0);
  body.reset({0, 1});
  world.run(0.1f);
  EXPECT_NEAR(body.centre_of_mass().y(), 1.25f, 1e-4f);
  EXPECT_LT(body.linear_momentum().norm(), 1e-6f);
}

TEST(Box2dCouplingOfCircles, KnowsItsParticles) {
  World2d world;
  b2Body* const box = world.add_box({0, 0}, {1, 1});
  SoftBody<2>& body = world.soft.add(rectangle_model({2, 2}, rubber()), {0, 5});
  int found = 0;
  for (const b2Body* b = world.box2d.GetBodyList(); b != nullptr; b = b->GetNext()) {
    const auto particle = world.soft.particle_of(*b);
    if (b == box) {
      EXPECT_EQ(particle.body, nullptr);
    } else {
      EXPECT_EQ(particle.body, &body);
      EXPECT_EQ(body.positions()[particle.number].x(), b->GetPosition().x);
      ++found;
    }
  }
  EXPECT_EQ(found, 8);
  world.soft.remove(body);
  EXPECT_EQ(world.box2d.GetBodyCount(), 1);
  EXPECT_EQ(world.soft.size(), 0u);
}

TEST_P(Box2dCoupling, RefusesWhatItIsNotGiven) {
  World2d world(9.81f, GetParam()), other(9.81f, GetParam());
  SoftBody<2>& body = other.soft.add(rectangle_model({1, 1}, rubber()), {0, 0});
  EXPECT_THROW(world.soft.remove(body), std::invalid_argument);
  EXPECT_THROW(rectangle_model({1, 1}, rubber(), 0), std::runtime_error);
  EXPECT_THROW(rectangle_model({1, 1}, {.cell_size = 0}), std::runtime_error);
}

TEST_P(Box2dCoupling, RefusesTheSkinOfAnotherModel) {
  World2d world(9.81f, GetParam());
  const auto model = rectangle_model({2, 2}, rubber());
  const Skin2d of_larger = make_skin_2d(rectangle_model({6, 3}, rubber())->lattice(), 0.5f);
  const Skin2d without_outlines =
      make_cover_2d(model->lattice(), [](const Eigen::Vector2i&) { return false; });
  EXPECT_THROW(world.soft.add(model, {0, 0}, &of_larger), std::invalid_argument);
  EXPECT_THROW(world.soft.add(model, {0, 0}, &without_outlines), std::invalid_argument);
  EXPECT_EQ(world.soft.size(), 0u);
}

TEST_P(Box2dCoupling, RefusesNumbersOutOfTheirRange) {
  World2d world(9.81f, GetParam());
  world.soft.add(rectangle_model({1, 1}, rubber()), {0, 0});
  try {
    static_cast<void>(world.soft[9]);
    FAIL() << "there is one body";
  } catch (const std::out_of_range& error) {
    EXPECT_STREQ(error.what(), "soft body 9 of a world of 1; the first one is 0");
  }
  for (const float wrong : {-1.0f, std::nanf("")}) {
    EXPECT_THROW(world.soft.let_sleep(SleepSettings{.speed = wrong}), std::invalid_argument);
    EXPECT_THROW(world.soft.let_sleep(SleepSettings{.seconds = wrong}), std::invalid_argument);
    EXPECT_THROW(world.soft.begin_ahead(wrong), std::invalid_argument);
  }
}

TEST_P(Box2dCoupling, AStepOfNoTimeChangesNothing) {
  World2d world(9.81f, GetParam());
  world.add_box({0, -1}, {10, 1});
  SoftBody<2>& body = world.soft.add(rectangle_model({3, 3}, rubber()), {0, 0.3f});
  world.run(1);
  const std::uint64_t before = state_hash(body);
  for (int i = 0; i < 3; ++i) world.soft.step(0);
  world.soft.begin_ahead(0);
  EXPECT_EQ(state_hash(body), before);
  for (const float wrong : {-0.5f, std::numeric_limits<float>::infinity(), std::nanf("")})
    EXPECT_THROW(world.soft.step(wrong), std::invalid_argument);
  world.run(1);
  EXPECT_TRUE(body.centre_of_mass().allFinite());
}

TEST_P(Box2dCoupling, FiltersSayWhatTouches) {
  World2d world(9.81f, GetParam());
  world.add_box({0, -1}, {10, 1});
  SoftBody<2>& under = world.soft.add(rectangle_model({6, 3}, rubber()), {0, 0.2f});
  SoftBody<2>& through = world.soft.add(rectangle_model({3, 3}, rubber()), {0, 1.6f});
  world.soft.set_filter(through, {.group = 2, .mask = 1});
  world.soft.set_filter(under, {.group = 1, .mask = 1});  // not 2
  world.run(4);
  EXPECT_LT(through.centre_of_mass().y(), 0.6f) << "it lies on the floor, in the other one";
  EXPECT_GT(lowest(through), 0);
  b2Filter none;
  none.maskBits = 0xFFFD;
  b2Body* floor = world.box2d.GetBodyList();
  while (floor->GetType() != b2_staticBody) floor = floor->GetNext();
  floor->GetFixtureList()->SetFilterData(none);
  world.run(1);
  EXPECT_LT(through.centre_of_mass().y(), -1);
  EXPECT_GT(lowest(under), 0);
  World2d other(0, GetParam());
  EXPECT_THROW(other.soft.set_filter(under, {}), std::invalid_argument);
}

TEST_P(Box2dCoupling, GravityOf300Holds) {
  World2d world(300, GetParam());
  world.add_box({0, -1}, {10, 1});
  SoftBodySettings settings = rubber();
  settings.alpha = 1;
  SoftBody<2>& body = world.soft.add(rectangle_model({4, 4}, settings), {0, 0.2f});
  world.run(10);
  EXPECT_TRUE(std::isfinite(body.centre_of_mass().y()));
  EXPECT_GT(lowest(body), 0) << "a particle's centre went below the floor";
}

/// Asleep on a floor, as far as it will.
struct Resting {
  explicit Resting(ContactMethod contacts) : world(9.81f, contacts) {
    floor = world.add_box({0, -1}, {10, 1});
    world.soft.let_sleep(SleepSettings{});
    body = &world.soft.add(rectangle_model({6, 4}, calm()), {0, 0.2f});
    world.run(12);
  }
  static SoftBodySettings calm() {
    SoftBodySettings settings = rubber();
    settings.damping = 0.3f;
    return settings;
  }

  World2d world;
  b2Body* floor;
  SoftBody<2>* body;
};

class Box2dSleep : public testing::TestWithParam<ContactMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, Box2dSleep,
                         testing::Values(ContactMethod::kSpheres, ContactMethod::kSurface), name_of_method);

TEST_P(Box2dSleep, ABodyAtRestStaysWhereItIs) {
  Resting resting(GetParam());
  ASSERT_TRUE(resting.body->asleep());
  EXPECT_NEAR(lowest(*resting.body), resting.body->model().contact_radius(), 0.05f);
  const std::uint64_t state = state_hash(*resting.body);
  resting.world.run(1);
  EXPECT_TRUE(resting.body->asleep());
  EXPECT_EQ(state_hash(*resting.body), state);
}

TEST_P(Box2dSleep, NobodySleepsUnlessAsked) {
  World2d world(9.81f, GetParam());
  world.add_box({0, -1}, {10, 1});
  SoftBody<2>& body = world.soft.add(rectangle_model({6, 4}, Resting::calm()), {0, 0.2f});
  world.run(12);
  EXPECT_FALSE(body.asleep());
}

TEST_P(Box2dSleep, ARigidBodyThatFallsOnItWakesIt) {
  Resting resting(GetParam());
  ASSERT_TRUE(resting.body->asleep());
  resting.world.add_box({0, 1.6f}, {0.2f, 0.2f}, 5);
  resting.world.run(0.05f);
  EXPECT_TRUE(resting.body->asleep()) << "it has not come down yet";
  const std::uint64_t state = state_hash(*resting.body);
  resting.world.run(0.5f);
  EXPECT_FALSE(resting.body->asleep());
  EXPECT_NE(state_hash(*resting.body), state);
}

TEST_P(Box2dSleep, ASoftBodyThatFallsOnItWakesIt) {
  Resting resting(GetParam());
  ASSERT_TRUE(resting.body->asleep());
  resting.world.soft.add(rectangle_model({2, 2}, rubber()), {0, 2.5f});
  resting.world.run(1);
  EXPECT_FALSE(resting.body->asleep());
}

TEST_P(Box2dSleep, NoticesWhatCreeps) {
  Resting resting(GetParam());
  ASSERT_TRUE(resting.body->asleep());
  const float before = resting.body->centre_of_mass().x(), side = resting.body->bounds().low.x();
  b2Body* const wall = resting.world.add_box({side - 1, 1}, {0.5f, 1});
  wall->SetType(b2_kinematicBody);
  wall->SetLinearVelocity({0.04f, 0});
  resting.world.run(25);  // a metre, of which half is before it comes
  EXPECT_NEAR(resting.body->centre_of_mass().x(), before + 0.5f, 0.2f);
}

TEST_P(Box2dSleep, WakesWhenGravityTurns) {
  Resting resting(GetParam());
  ASSERT_TRUE(resting.body->asleep());
  const float before = resting.body->centre_of_mass().x();
  resting.world.box2d.SetGravity({9.81f, -2});
  resting.world.run(0.5f);
  EXPECT_FALSE(resting.body->asleep());
  EXPECT_GT(resting.body->centre_of_mass().x(), before + 0.1f);
}

TEST_P(Box2dSleep, WakesWhenItsUserChangesIt) {
  Resting resting(GetParam());
  ASSERT_TRUE(resting.body->asleep());
  resting.body->add_velocity({0, 3});
  resting.world.run(0.1f);
  EXPECT_FALSE(resting.body->asleep());
  EXPECT_GT(lowest(*resting.body), resting.body->model().contact_radius() + 0.1f);
}

TEST(Box2dSleepOfCircles, WakesWhenAParticleIsPushed) {
  Resting resting(ContactMethod::kSpheres);
  ASSERT_TRUE(resting.body->asleep());
  for (b2Body* b = resting.world.box2d.GetBodyList(); b != nullptr; b = b->GetNext())
    if (resting.world.soft.particle_of(*b).number == 0) b->ApplyLinearImpulseToCenter({0, 0.1f}, true);
  resting.world.soft.step(1.0f / 120);
  EXPECT_FALSE(resting.body->asleep());
}

TEST_P(Box2dSleep, FallsWhenTheFloorIsTakenAway) {
  Resting resting(GetParam());
  ASSERT_TRUE(resting.body->asleep());
  resting.world.box2d.DestroyBody(resting.floor);
  resting.world.run(1);
  EXPECT_LT(resting.body->centre_of_mass().y(), -1);
}

TEST_P(Box2dSleep, FallsWhateverTakesTheFloorAway) {
  const std::vector<std::pair<const char*, std::function<void(b2Body&)>>> ways = {
      {"destroyed", [](b2Body& floor) { floor.DestroyFixture(floor.GetFixtureList()); }},
      {"disabled", [](b2Body& floor) { floor.SetEnabled(false); }},
      {"a sensor", [](b2Body& floor) { floor.GetFixtureList()->SetSensor(true); }},
      {"filtered",
       [](b2Body& floor) {
         b2Filter nobody;
         nobody.maskBits = 0;
         floor.GetFixtureList()->SetFilterData(nobody);
       }},
      {"lowered",
       [](b2Body& floor) {
         floor.SetTransform({0, -4}, 0);
       }},
      {"far away",
       [](b2Body& floor) {
         floor.SetTransform({500, 0}, 0);
       }},
      {"exchanged",  // most likely at the same place in memory
       [](b2Body& floor) {
         floor.DestroyFixture(floor.GetFixtureList());
         b2PolygonShape flat;
         flat.SetAsBox(10, 0.1f);
         floor.CreateFixture(&flat, 0);
       }},
  };
  for (const auto& [name, take_away] : ways) {
    Resting resting(GetParam());
    ASSERT_TRUE(resting.body->asleep());
    const float before = resting.body->centre_of_mass().y();
    take_away(*resting.floor);
    resting.world.run(1);
    EXPECT_LT(resting.body->centre_of_mass().y(), before - 0.5f) << name;
  }
}

TEST_P(Box2dSleep, SleepsOnWhateverHappensToWhatItDoesNotTouch) {
  Resting resting(GetParam());
  b2Body* const far = resting.world.add_box({8, 3}, {1, 1});
  ASSERT_TRUE(resting.body->asleep());
  far->SetTransform({-8, 3}, 0);
  far->DestroyFixture(far->GetFixtureList());
  resting.world.run(0.1f);
  EXPECT_TRUE(resting.body->asleep());
}

TEST_P(Box2dSleep, WakesWhenBodiesMayNoLongerSleep) {
  Resting resting(GetParam());
  ASSERT_TRUE(resting.body->asleep());
  resting.world.soft.let_sleep(std::nullopt);
  EXPECT_FALSE(resting.body->asleep());
  resting.world.run(3);
  EXPECT_FALSE(resting.body->asleep());
}

/// A soft body on another, and a rigid box on top of both.
struct Tower {
  explicit Tower(ContactMethod contacts) : world(9.81f, contacts) {
    world.add_box({0, -1}, {10, 1});
    world.soft.let_sleep(SleepSettings{});
    under = &world.soft.add(rectangle_model({6, 3}, Resting::calm()), {0, 0.2f});
    over = &world.soft.add(rectangle_model({4, 2}, Resting::calm()), {0, 1.3f});
    box = world.add_box({0, 2.4f}, {0.3f, 0.2f}, 3);
  }
  World2d world;
  SoftBody<2>*under, *over;
  b2Body* box;
};

TEST_P(Box2dSleep, WhatTouchesSleepsTogether) {
  Tower tower(GetParam());
  bool together = true;
  for (int i = 0; i < 3600; ++i) {
    tower.world.soft.step(1.0f / 120);
    together &= tower.under->asleep() == tower.over->asleep() && tower.over->asleep() != tower.box->IsAwake();
  }
  EXPECT_TRUE(together);
  EXPECT_TRUE(tower.under->asleep());
  tower.world.soft.remove(*tower.over);  // what lay on it wakes, and it wakes itself
  tower.world.run(0.1f);
  EXPECT_FALSE(tower.under->asleep());
  EXPECT_TRUE(tower.box->IsAwake());
}

TEST_P(Box2dSleep, FallsWhenTheBodyBelowIsTakenAway) {
  using Bodies = Box2dSoftBodies;
  const std::vector<std::pair<const char*, std::function<void(Bodies&, SoftBody<2>&)>>> ways = {
      {"translate",
       [](Bodies&, SoftBody<2>& under) {
         under.translate({20, 0});
       }},
      {"reset",
       [](Bodies&, SoftBody<2>& under) {
         under.reset({20, 2});
       }},
      {"move_without_force",
       [](Bodies&, SoftBody<2>& under) {
         under.move_without_force(Eigen::Rotation2Df(0), {20, 0});
       }},
      {"set_filter", [](Bodies& all, SoftBody<2>& under) { all.set_filter(under, {.group = 2, .mask = 0}); }},
  };
  for (const auto& [name, take_away] : ways) {
    Tower tower(GetParam());
    tower.world.run(30);
    ASSERT_TRUE(tower.under->asleep() && tower.over->asleep()) << name;
    const float before = tower.over->centre_of_mass().y();
    take_away(tower.world.soft, *tower.under);
    tower.world.run(1);
    EXPECT_LT(tower.over->centre_of_mass().y(), before - 0.4f) << name;
  }
}

TEST_P(Box2dSleep, ARigidBodyThatMayNotSleepKeepsWhatItTouchesAwake) {
  Tower tower(GetParam());
  tower.box->SetSleepingAllowed(false);
  tower.world.run(20);
  EXPECT_FALSE(tower.over->asleep());
}

}  // namespace
}  // namespace softcell::ppu
