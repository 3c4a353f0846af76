// What moves meets a body where it will be at the substep's end, wherever it was when Bullet last looked.

#include <gtest/gtest.h>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "contact_world.h"
#include "ppu/obstacles/moved_by_place.h"
#include "softcell/soft_bodies/attachment.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr float kOfCube = 0.1f;
constexpr float kFast = 20;  // m/s: 1.7 cells a substep

struct Thrown {
  std::string name;
  std::unique_ptr<btCollisionShape> shape;
  float front;  ///< metres: so far before its origin is its foremost point
};

class ThrownThings {
 public:
  std::vector<Thrown> all() {
    std::vector<Thrown> things;
    things.push_back({"ball", std::make_unique<btSphereShape>(0.1f), 0.1f});
    things.push_back({"box", std::make_unique<btBoxShape>(btVector3(0.1f, 0.1f, 0.1f)), 0.1f});
    auto cone = std::make_unique<btConeShapeX>(0.1f, 0.3f);
    cone->setMargin(0.001f);
    things.push_back({"cone", std::move(cone), 0.15f});
    auto compound = std::make_unique<btCompoundShape>();
    for (const float x : {-0.5f, 0.5f})
      compound->addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(x, 0, 0)), &child_);
    things.push_back({"compound", std::move(compound), 0.6f});
    return things;
  }

 private:
  btSphereShape child_{0.1f};
};

/// They were seen a substep late, 1.7 cells deep, and stayed there for as long as pushes took to bring them out.
TEST(MovingObstacles, WhatIsThrownIsMetWhereverItBegins) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  ThrownThings things;
  for (int place = 0; place < 8; ++place) {
    for (Thrown& thing : things.all()) {
      ContactWorld w({0, 0, 0});
      const SoftBody<3>& body =
          w.add(make_box({0.7f, 0.7f, 0.7f}, kOfCube), settings_of(kOfCube, 0.7f), {0, 0, 0});
      const float gap = 0.4f + kFast * kStep * static_cast<float>(place) / 8;
      btRigidBody& rigid = w.add(std::move(thing.shape), 0.05f * body.model().mass(),
                                 {-0.35f - gap - thing.front, 0.03f, 0.02f});
      rigid.setLinearVelocity({kFast, 0, 0});
      float deepest = 0;
      for (int i = 0; i < 12; ++i) {
        w.run(1);
        const btVector3 front = rigid.getWorldTransform() * btVector3(thing.front, 0, 0);
        deepest = std::max(deepest, ContactWorld::depth_in_drawn(body, to_eigen(front)));
      }
      EXPECT_LT(rigid.getLinearVelocity().x(), kFast / 2) << thing.name << " has met nothing";
      EXPECT_LT(deepest, 0.3f * kOfCube) << thing.name << ", " << gap << " m before the body";
    }
  }
}

/// A body that is moved by its motion state; Bullet derives its velocity.
struct MovedBySomebody final : btMotionState {
  btTransform pose = btTransform::getIdentity();
  void getWorldTransform(btTransform& world) const override { world = pose; }
  void setWorldTransform(const btTransform&) override {}
};

TEST(MovingObstacles, AWallThatIsMovedPushesABodyAlong) {
  for (const float speed : {5.0f, kFast}) {
    MovedBySomebody moved;  // outlives the world
    ContactWorld w({0, 0, 0});
    const SoftBody<3>& body =
        w.add(make_box({0.7f, 0.7f, 0.7f}, kOfCube), settings_of(kOfCube, 0.7f), {0, 0, 0});
    btRigidBody& wall = w.add(std::make_unique<btBoxShape>(btVector3(0.02f, 1, 1)), 0, {-1, 0, 0});
    wall.setCollisionFlags(wall.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    wall.setActivationState(DISABLE_DEACTIVATION);
    wall.setMotionState(&moved);
    float deepest = 0;
    for (int i = 0; i < 40; ++i) {
      moved.pose.setOrigin(btVector3(-1 + speed * kStep * static_cast<float>(i), 0, 0));
      w.world.stepSimulation(kStep, 0);
      // Bullet's velocity of it is that of its last way, and the body has gone this way with it.
      const float front = moved.pose.getOrigin().x() + 0.02f + speed * kStep;
      for (const Vector3f& p : ContactWorld::drawn(body)) deepest = std::max(deepest, front - p.x());
    }
    EXPECT_LT(deepest, 0.15f * kOfCube) << speed << " m/s";
    EXPECT_GT(body.centre_of_mass().x(), 0) << speed << " m/s";
  }
}

/// Bullet's solver multiplies the effect of impulses by these factors: characters do not turn, and games in a plane stay in it.
/// Bullet knows no velocity of a static body, of a kinematic one that it has put to sleep, of a collision object, or of a ghost such as its character controller moves. They went
/// through soft bodies from 1 m/s on.
TEST(MovingObstacles, WhatIsMovedByItsPlacePushesABodyAlong) {
  enum { kStatic, kWithJoint, kAsleep, kObject, kKinematicObject, kGhost, kKinds };
  for (const float speed : {0.5f, 2.0f, 5.0f})
    for (int kind = 0; kind < kKinds; ++kind) {
      ContactWorld w;
      w.add_floor();
      const SoftBody<3>& body =
          w.add(make_box({0.4f, 0.4f, 0.4f}, kOfCube), settings_of(kOfCube, 0.7f, 0.2f), {0, 0.201f, 0});
      btBoxShape shape({0.1f, 0.5f, 0.5f});
      btRigidBody door(0, nullptr, &shape);
      btCollisionObject object;
      btPairCachingGhostObject ghost;
      const bool is_door = kind == kStatic || kind == kWithJoint || kind == kAsleep;
      btCollisionObject& pusher = is_door ? door : kind == kGhost ? ghost : object;
      pusher.setCollisionShape(&shape);
      btTransform pose = btTransform::getIdentity();
      pose.setOrigin({-0.5f, 0.51f, 0});
      pusher.setWorldTransform(pose);
      if (kind == kKinematicObject || kind == kAsleep)
        pusher.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
      // After two seconds at rest, unless DISABLE_DEACTIVATION forbids it.
      if (kind == kAsleep) pusher.forceActivationState(ISLAND_SLEEPING);
      if (is_door)
        w.world.addRigidBody(&door);
      else
        w.world.addCollisionObject(&pusher, btBroadphaseProxy::StaticFilter,
                                   btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
      btRigidBody& lamp = w.add(std::make_unique<btSphereShape>(0.1f), 1, {-0.5f, 0.5f, 1}, 1);
      btPoint2PointConstraint hinge(door, lamp, {0, 0, 0.7f}, {0, 0, -0.3f});
      if (kind == kWithJoint) w.world.addConstraint(&hinge, true);
      for (int i = 0; i < 60; ++i) {
        pose.getOrigin() += btVector3(speed * kStep, 0, 0);
        pusher.setWorldTransform(pose);
        w.world.stepSimulation(kStep, 0);
        float left = std::numeric_limits<float>::max();
        for (const Vector3f& p : ContactWorld::drawn(body)) left = std::min(left, p.x());
        // Its first way is spread over four substeps, as it may have moved for a frame of so many.
        if (i > 4) {
          ASSERT_GT(left, pose.getOrigin().x() + 0.1f - 0.1f * kOfCube)
              << speed << " m/s, kind " << kind << ", step " << i;
        }
      }
      if (kind == kWithJoint) w.world.removeConstraint(&hinge);
      w.world.removeCollisionObject(&pusher);
    }
}

/// One of Bullet's own soft bodies has a shape that softcell cannot touch. Each step threw.
TEST(MovingObstacles, BulletsOwnSoftBodiesArePassedThrough) {
  struct NoShape final : btCollisionShape {
    NoShape() { m_shapeType = SOFTBODY_SHAPE_PROXYTYPE; }
    void getAabb(const btTransform&, btVector3& low, btVector3& high) const override {
      low.setValue(-1, -1, -1), high.setValue(1, 1, 1);
    }
    void setLocalScaling(const btVector3&) override {}
    const btVector3& getLocalScaling() const override { return scaling; }
    void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
    const char* getName() const override { return "SoftBody"; }
    void setMargin(btScalar) override {}
    btScalar getMargin() const override { return 0; }
    btVector3 scaling{1, 1, 1};
  };
  struct Cloth final : btCollisionObject {
    Cloth() { m_internalType = CO_SOFT_BODY; }
  };
  NoShape shape;
  Cloth cloth;
  cloth.setCollisionShape(&shape);
  ContactWorld w;
  const SoftBody<3>& body =
      w.add(make_box({0.4f, 0.4f, 0.4f}, kOfCube), settings_of(kOfCube, 0.7f, 0.2f), {0, 0.5f, 0});
  w.world.addCollisionObject(&cloth);
  EXPECT_NO_THROW(w.run(30));
  EXPECT_LT(body.centre_of_mass().y(), 0.5f - 0.4f * 9.81f * 0.25f);
  w.world.removeCollisionObject(&cloth);
}

/// A lift so slow that nobody on it moves fast enough to wake others.
TEST(MovingObstacles, ASleepingStackFollowsASlowLift) {
  for (const float speed : {-0.04f, 0.04f})
    for (const bool is_kinematic : {false, true}) {
      ContactWorld w;
      w.bodies.let_sleep(SleepSettings{});
      btRigidBody& lift = w.add(std::make_unique<btBoxShape>(btVector3(1, 0.1f, 1)), 0, {0, -0.1f, 0});
      if (is_kinematic) {
        lift.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
        lift.setActivationState(DISABLE_DEACTIVATION);
      }
      std::vector<const SoftBody<3>*> stack;
      for (int i = 0; i < 3; ++i)
        stack.push_back(&w.add(make_box({0.4f, 0.2f, 0.4f}, kOfCube), settings_of(kOfCube, 0.7f, 0.3f),
                               {0, 0.101f + 0.2f * static_cast<float>(i), 0}));
      w.run(300);
      ASSERT_TRUE(stack[2]->asleep());
      std::vector<float> before;
      for (const SoftBody<3>* const body : stack) before.push_back(body->centre_of_mass().y());
      btTransform pose = lift.getWorldTransform();
      for (int i = 0; i < 480; ++i) {
        pose.getOrigin() += btVector3(0, speed * kStep, 0);
        lift.setWorldTransform(pose);
        w.world.stepSimulation(kStep, 0);
      }
      w.run(60);
      for (std::size_t i = 0; i < stack.size(); ++i)
        EXPECT_NEAR(stack[i]->centre_of_mass().y() - before[i], 4 * speed, 0.1f * kOfCube)
            << speed << " m/s, kinematic " << is_kinematic << ", body " << i;
    }
}

/// Such as a level that is put somewhere else: it does not sweep through what lies between.
TEST(MovingObstacles, WhatIsPutFarAwayPushesNothingOnItsWay) {
  ContactWorld w({0, 0, 0});
  const SoftBody<3>& body =
      w.add(make_box({0.4f, 0.4f, 0.4f}, kOfCube), settings_of(kOfCube, 0.7f, 0.2f), {0, 0, 0});
  btRigidBody& block = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.2f, 0.2f)), 0, {-2, 0, 0});
  w.run(1);
  btTransform pose = block.getWorldTransform();
  pose.setOrigin({2, 0, 0});
  block.setWorldTransform(pose);
  w.run(30);
  EXPECT_LT(body.centre_of_mass().norm(), 1e-5f);
}

TEST(MovingObstacles, AWeldFollowsAStaticBodyThatIsMovedByItsPlace) {
  ContactWorld w;
  btRigidBody& hook = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.1f, 0.2f)), 0, {0, 1, 0});
  SoftBody<3>& body =
      w.add(make_box({0.4f, 0.4f, 0.4f}, kOfCube), settings_of(kOfCube, 0.9f, 0.2f), {0, 0.65f, 0});
  const AttachmentId weld =
      w.bodies.attach(body, Patch<3>::of_surface({0, 0.85f, 0}, 0.2f), hook, {.kind = AttachmentKind::kWeld});
  float widest = 0;
  btTransform pose = hook.getWorldTransform();
  for (int i = 0; i < 120; ++i) {
    pose.getOrigin() += btVector3(1 * kStep, 0, 0);
    hook.setWorldTransform(pose);
    w.world.stepSimulation(kStep, 0);
    const auto state = w.bodies.attachment(weld);
    ASSERT_TRUE(state);
    widest = std::max(widest, state->gap);
  }
  EXPECT_LT(widest, 0.1f * kOfCube);
  EXPECT_NEAR(body.centre_of_mass().x(), 1, 0.1f);
}

Pose turned(const Vector3f& position, float angle) {
  return {position, Eigen::AngleAxisf(angle, Vector3f::UnitY()).toRotationMatrix()};
}

/// How many substeps lie between two changes is known from the second change on; before that four are assumed.
TEST(FollowedPlace, SpreadsItsWayOverTheSubstepsOfAFrame) {
  constexpr float kWay = 0.01f, kTurn = 0.02f;
  for (const int substeps : {1, 3, 8}) {
    FollowedPlace place(turned({1, 2, 3}, 0));
    Vector3f at(1, 2, 3);
    for (int frame = 1; frame <= 4; ++frame) {
      const Pose now =
          turned({1 + kWay * static_cast<float>(frame), 2, 3}, kTurn * static_cast<float>(frame));
      for (int i = 0; i < substeps; ++i) {
        if (place.stands(now)) {
          EXPECT_EQ(frame, 1) << "only the first frame's length is unknown";
          place.stand();
          continue;
        }
        const auto motion = place.follow(now, 1, kStep);
        ASSERT_TRUE(motion);
        EXPECT_LT((motion->from.position - at).norm(), 1e-6f);
        at += kStep * motion->velocity;
        if (frame < 3) continue;
        const float speed = kWay / (kStep * static_cast<float>(substeps));
        EXPECT_LT((motion->velocity - Vector3f(speed, 0, 0)).norm(), 1e-3f * speed) << substeps;
        EXPECT_LT((motion->spin - Vector3f(0, 2 * speed, 0)).norm(), 2e-3f * speed) << substeps;
      }
      if (frame == 1) continue;
      EXPECT_LT((at - now.position).norm(), 1e-6f) << "at the frame's end it is there";
    }
  }
}

TEST(FollowedPlace, IsPutElsewhereByWhatIsTooFar) {
  const Pose from = turned({1, 2, 3}, 0);
  const auto is_followed = [&](const Pose& to, float size) {
    FollowedPlace place(from);
    EXPECT_TRUE(place.stands(from));
    EXPECT_FALSE(place.stands(to));
    const bool moves = place.follow(to, size, 0.001f).has_value();
    EXPECT_NE(place.stands(to), moves);
    return moves;
  };
  EXPECT_TRUE(is_followed(turned({1.3f, 2, 3}, 1), 1));
  EXPECT_FALSE(is_followed(turned({1.6f, 2, 3}, 0), 1)) << "more than half of its size";
  EXPECT_FALSE(is_followed(turned({1.5f, 2, 3}, 0), 10)) << "125 m/s";
  EXPECT_FALSE(is_followed(turned({1, 2, 3}, 1.1f), 1)) << "by more than 60 degrees";
}

/// A program that sets places once a frame throws nothing, however many substeps the frame has.
TEST(MovingObstacles, WhatIsMovedOnceAFrameThrowsNothing) {
  constexpr float kSpeed = 1;
  for (const int substeps : {1, 4, 8}) {
    ContactWorld w;
    btRigidBody& lift = w.add(std::make_unique<btBoxShape>(btVector3(0.5f, 0.1f, 0.5f)), 0, {0, -0.1f, 0});
    const SoftBody<3>& body =
        w.add(make_box({0.4f, 0.4f, 0.4f}, kOfCube), settings_of(kOfCube, 0.7f, 0.2f), {0, 0.201f, 0});
    w.run(20, substeps);
    btTransform pose = lift.getWorldTransform();
    float highest = 0;
    for (int frame = 0; frame < 60; ++frame) {
      pose.getOrigin() += btVector3(0, kSpeed / 60, 0);
      lift.setWorldTransform(pose);
      w.run(1, substeps);
      const float above = ContactWorld::lowest_drawn(body) - pose.getOrigin().y() - 0.1f;
      // The first way of a frame is spread over four substeps.
      EXPECT_GT(above, frame == 0 ? -0.2f * kOfCube : -0.1f * kOfCube) << substeps << ", frame " << frame;
      highest = std::max(highest, above);
    }
    EXPECT_LT(highest, 0.3f * kOfCube) << substeps;
    EXPECT_NEAR(body.linear_momentum().y() / body.model().mass(), kSpeed, 0.1f) << substeps;
  }
}

TEST(MovingObstacles, MoveAlongAndAboutTheAxesThatBulletLeavesThem) {
  const auto falls_on = [](const btVector3& linear, const btVector3& angular, bool attached) {
    ContactWorld w;
    btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.2f, 0.2f)), 5, {0, 0, 0});
    box.setLinearFactor(linear);
    box.setAngularFactor(angular);
    SoftBody<3>& soft =
        w.add(make_box({0.3f, 0.3f, 0.3f}, kOfCube), settings_of(kOfCube), {0.15f, 0.4f, 0.1f});
    soft.add_velocity({1, -3, 1});
    if (attached) w.bodies.attach(soft, Patch<3>::of_surface({0.1f, 0.25f, 0}, 0.2f), box);
    w.run(30);
    for (const Vector3f& x : soft.positions()) EXPECT_TRUE(x.allFinite());
    return box.getWorldTransform();
  };
  for (const bool attached : {false, true}) {
    SCOPED_TRACE(attached ? "attached" : "touched");
    const btTransform fixed = falls_on({0, 0, 0}, {0, 0, 0}, attached);
    EXPECT_EQ(fixed.getOrigin(), btVector3(0, 0, 0));
    EXPECT_EQ(fixed.getRotation().getAngle(), 0);
    const btTransform upright = falls_on({1, 1, 1}, {0, 0, 0}, attached);
    EXPECT_LT(upright.getOrigin().y(), -1);
    EXPECT_EQ(upright.getRotation().getAngle(), 0);
    const btTransform turning = falls_on({0, 0, 0}, {1, 1, 1}, attached);
    EXPECT_EQ(turning.getOrigin(), btVector3(0, 0, 0));
    EXPECT_GT(turning.getRotation().getAngle(), 0.1f);
    const btTransform in_plane = falls_on({1, 1, 0}, {0, 0, 1}, attached);
    EXPECT_EQ(in_plane.getOrigin().z(), 0);
    EXPECT_NE(in_plane.getOrigin().x(), 0);
    EXPECT_NEAR(in_plane.getBasis().getColumn(2).z(), 1, 1e-6f);
  }
}

/// What it lies on helps it to carry, as if it could move along all axes.
TEST(MovingObstacles, ALightCrateOfAGameInAPlaneCarriesAHeavySoftBody) {
  for (const auto& [linear, angular] :
       {std::pair(btVector3(1, 1, 0), btVector3(0, 0, 1)), std::pair(btVector3(0, 1, 0), btVector3(0, 0, 0)),
        std::pair(btVector3(1, 1, 1), btVector3(0, 0, 0))}) {
    ContactWorld w;
    w.add_floor();
    btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.2f, 0.2f)), 2, {0, 0.2f, 0});
    box.setLinearFactor(linear);
    box.setAngularFactor(angular);
    SoftBodySettings heavy = settings_of(kOfCube, 0.8f, 0.4f);
    heavy.density = 500;
    const SoftBody<3>& soft = w.add(make_box({0.3f, 0.3f, 0.3f}, kOfCube), heavy, {0, 0.56f, 0});
    ASSERT_GT(soft.model().mass(), 5);
    w.run(180);
    EXPECT_GT(ContactWorld::lowest_drawn(soft), 0.4f - 0.1f * kOfCube);
    EXPECT_NEAR(box.getWorldTransform().getOrigin().y(), 0.2f, 0.01f);
  }
}

/// Bullet does not look at a static body's velocity, which is often left from when it was dynamic.
TEST(MovingObstacles, ACrateThatIsFrozenInFlightCarriesNothingAway) {
  struct Left {
    btVector3 velocity, spin;
  };
  for (const auto& [velocity, spin] : {Left{{1, 0, 0}, {0, 0, 0}}, Left{{0, -3, 0}, {0, 0, 0}},
                                       Left{{0, 3, 0}, {0, 0, 0}}, Left{{0, 0, 0}, {0, 5, 0}}}) {
    ContactWorld w;
    btRigidBody& crate = w.add(std::make_unique<btBoxShape>(btVector3(0.5f, 0.25f, 0.5f)), 2, {0, -0.25f, 0});
    w.world.removeRigidBody(&crate);
    crate.setLinearVelocity(velocity);
    crate.setAngularVelocity(spin);
    crate.setMassProps(0, {0, 0, 0});
    w.world.addRigidBody(&crate);
    const SoftBody<3>& soft =
        w.add(make_box({0.4f, 0.4f, 0.4f}, kOfCube), settings_of(kOfCube, 0.7f, 0.3f), {0, 0.22f, 0});
    w.bodies.let_sleep(SleepSettings{});
    w.run(180);
    const Vector3f centre = soft.centre_of_mass();
    EXPECT_LT(centre.cwiseProduct(Vector3f(1, 0, 1)).norm(), 0.02f) << to_eigen(velocity).transpose();
    EXPECT_NEAR(ContactWorld::lowest_drawn(soft), 0, 0.1f * kOfCube) << to_eigen(velocity).transpose();
    EXPECT_TRUE(soft.asleep()) << to_eigen(spin).transpose();
  }
}

}  // namespace
}  // namespace softcell::ppu
