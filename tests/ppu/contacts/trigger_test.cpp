// Trigger volumes: objects without contact response, of which a program is told which soft bodies are in them.

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "contact_world.h"
#include "ppu/contacts/overlap.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Kind = ContactEvent::Kind;

/// Outlives the worlds that it is added to.
class Trigger {
 public:
  explicit Trigger(std::unique_ptr<btCollisionShape> shape, const btVector3& at = {0, 0, 0})
      : shape_(std::move(shape)) {
    object_.setCollisionShape(shape_.get());
    object_.setCollisionFlags(object_.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    move_to(at);
  }
  btCollisionObject& object() { return object_; }
  void move_to(const btVector3& at) {
    object_.setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
  }

 private:
  std::unique_ptr<btCollisionShape> shape_;
  btCollisionObject object_;
};

std::unique_ptr<btCollisionShape> box(float x, float y, float z) {
  return std::make_unique<btBoxShape>(btVector3(x, y, z));
}

TEST(TriggerVolumes, TellWhoFallsThroughThemAndHoldNobody) {
  Trigger gate(box(2, 0.1f, 2));
  ContactWorld with({0, -9.81f, 0}), without({0, -9.81f, 0});
  with.world.addCollisionObject(&gate.object());
  with.bodies.watch_contacts(true);
  const auto mesh = make_box({0.5f, 0.5f, 0.5f}, 0.125f);
  const SoftBody<3>& body = with.add(mesh, settings_of(0.125f), {0, 1, 0});
  const SoftBody<3>& free = without.add(mesh, settings_of(0.125f), {0, 1, 0});
  std::vector<Kind> kinds;
  float entered = 0, left = 0;
  for (int i = 0; i < 120; ++i) {
    with.run(1);
    without.run(1);
    ASSERT_EQ(body.centre_of_mass(), free.centre_of_mass()) << i;
    for (const ContactEvent& event : with.bodies.poll_contact_events()) {
      EXPECT_EQ(event.body, &body);
      EXPECT_EQ(event.object, &gate.object());
      EXPECT_EQ(event.other, nullptr);
      EXPECT_EQ(event.impulse, 0);
      EXPECT_LT(std::abs(event.position.y()), 0.11f) << i;
      EXPECT_NEAR(event.normal.norm(), 1, 1e-4f);
      kinds.push_back(event.kind);
      if (event.kind == Kind::kBegin) entered = body.centre_of_mass().y();
      if (event.kind == Kind::kEnd) left = body.centre_of_mass().y();
    }
  }
  ASSERT_GE(kinds.size(), 3u);
  EXPECT_EQ(kinds.front(), Kind::kBegin);
  EXPECT_EQ(kinds.back(), Kind::kEnd);
  for (std::size_t i = 1; i + 1 < kinds.size(); ++i) EXPECT_EQ(kinds[i], Kind::kPersist);
  // The frame in which it enters moves it by 6 cm, the one after it has left by 9 cm.
  EXPECT_LE(entered, 0.35f);
  EXPECT_GT(entered, 0.35f - 0.065f);
  EXPECT_LE(left, -0.35f);
  EXPECT_GT(left, -0.35f - 0.09f);
}

std::unique_ptr<btCollisionShape> triangle(btTriangleMesh& mesh, float size, float height) {
  mesh.addTriangle({-size, height, -size}, {size, height, -size}, {0, height, size});
  return std::make_unique<btBvhTriangleMeshShape>(&mesh, true);
}

TEST(TriggerVolumes, OfEveryShapeKnowWhoIsInThem) {
  const auto hull = [] {
    auto shape = std::make_unique<btConvexHullShape>();
    for (const btVector3& p :
         {btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, 0), btVector3(0, 0, 1)})
      shape->addPoint(p);
    return shape;
  };
  struct Case {
    const char* what;
    std::unique_ptr<btCollisionShape> shape;
    btVector3 at;
    bool inside;
  };
  btBoxShape part({0.1f, 0.1f, 0.1f});
  auto pair = std::make_unique<btCompoundShape>();
  pair->addChildShape(btTransform(btQuaternion::getIdentity(), {3, 0, 0}), &part);
  pair->addChildShape(btTransform(btQuaternion::getIdentity(), {0.1f, 0, 0}), &part);
  btTriangleMesh wide, above, small;
  // A cube of 1 m about the origin, cells of 0.25 m.
  Case cases[] = {
      {"a sheet between two layers of points", box(3, 0.0005f, 3), {0, 0.06f, 0}, true},
      {"a sheet above", box(3, 0.0005f, 3), {0, 0.6f, 0}, false},
      {"a wire", std::make_unique<btCylinderShape>(btVector3(0.0005f, 3, 0.0005f)), {0.06f, 0, 0.06f}, true},
      {"a wire beside",
       std::make_unique<btCylinderShape>(btVector3(0.0005f, 3, 0.0005f)),
       {0.6f, 0, 0},
       false},
      {"a thin capsule", std::make_unique<btCapsuleShape>(0.001f, 4.0f), {0.06f, 0, 0.06f}, true},
      {"something small within", std::make_unique<btSphereShape>(0.01f), {0.06f, 0.06f, 0.06f}, true},
      {"something large around", std::make_unique<btSphereShape>(5.0f), {0, 0, 0}, true},
      {"a sphere that dips in", std::make_unique<btSphereShape>(0.2f), {0.62f, 0.03f, 0.03f}, true},
      {"a sphere beside", std::make_unique<btSphereShape>(0.2f), {0.75f, 0, 0}, false},
      {"a sphere off an edge", std::make_unique<btSphereShape>(0.2f), {0.68f, 0.68f, 0}, false},
      {"a cone's tip", std::make_unique<btConeShape>(0.2f, 1.0f), {0.06f, -0.7f, 0.06f}, true},
      {"a cone below", std::make_unique<btConeShape>(0.2f, 1.0f), {0.06f, -1.1f, 0.06f}, false},
      {"a hull's corner", hull(), {0.44f, 0.44f, 0.44f}, true},
      {"a hull off a corner", hull(), {0.55f, 0.55f, 0.55f}, false},
      {"one of two boxes", std::move(pair), {0, 0, 0}, true},
      {"half of space", std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), 0.0f), {0, 0, 0}, true},
      {"half of space below",
       std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), -0.6f),
       {0, 0, 0},
       false},
      {"a wide triangle", triangle(wide, 9, 0.06f), {0, 0, 0}, true},
      {"a wide triangle above", triangle(above, 9, 0.6f), {0, 0, 0}, false},
      {"a small triangle within", triangle(small, 0.02f, 0.06f), {0, 0, 0}, true},
  };
  for (Case& c : cases) {
    Trigger trigger(std::move(c.shape), c.at);
    ContactWorld w({0, 0, 0});
    w.world.addCollisionObject(&trigger.object());
    const SoftBody<3>& body = w.add(make_box({1, 1, 1}, 0.25f), settings_of(0.25f), {0, 0, 0});
    w.bodies.watch_contacts(true);
    w.run(1);
    EXPECT_EQ(w.bodies.poll_contact_events().size(), c.inside ? 1u : 0u) << c.what;
    EXPECT_LT(body.centre_of_mass().norm(), 1e-5f) << c.what;
  }
}

TEST(TriggerVolumes, MeetBodiesThatSleepAndDoNotWakeThem) {
  Trigger hand(std::make_unique<btSphereShape>(0.2f), {5, 0.25f, 0});
  ContactWorld w({0, -9.81f, 0});
  w.add_floor();
  w.world.addCollisionObject(&hand.object());
  w.bodies.let_sleep(SleepSettings{});
  const SoftBody<3>& body =
      w.add(make_box({0.5f, 0.5f, 0.5f}, 0.125f), settings_of(0.125f, 0.5f, 0.3f), {0, 0.26f, 0});
  for (int i = 0; i < 1200 && !body.asleep(); ++i) w.run(1);
  ASSERT_TRUE(body.asleep());
  w.bodies.watch_contacts(true);
  w.run(2);
  EXPECT_TRUE(w.bodies.poll_contact_events().empty());
  std::vector<Kind> kinds;
  for (const float x : {0.1f, 0.15f, 5.0f, 5.0f}) {
    hand.move_to({x, 0.25f, 0});
    w.run(2);
    for (const ContactEvent& event : w.bodies.poll_contact_events()) kinds.push_back(event.kind);
  }
  EXPECT_EQ(kinds, (std::vector<Kind>{Kind::kBegin, Kind::kPersist, Kind::kEnd}));
  EXPECT_TRUE(body.asleep());
}

/// Bullet's broad phase learns only later in a substep where the program has moved a trigger volume.
TEST(TriggerVolumes, MeetABodyInTheSubstepInWhichTheProgramHasMovedThem) {
  Trigger hand(std::make_unique<btSphereShape>(0.2f), {5, 0, 0});
  ContactWorld w({0, 0, 0});
  w.world.addCollisionObject(&hand.object());
  w.add(make_box({0.5f, 0.5f, 0.5f}, 0.125f), settings_of(0.125f), {0, 0, 0});
  w.bodies.watch_contacts(true);
  w.run(3, 1);
  EXPECT_TRUE(w.bodies.poll_contact_events().empty());
  for (const auto& [x, kind] :
       {std::pair(0.1f, Kind::kBegin), std::pair(5.0f, Kind::kEnd), std::pair(-0.1f, Kind::kBegin)}) {
    hand.move_to({x, 0, 0});
    w.run(1, 1);
    const std::vector<ContactEvent> events = w.bodies.poll_contact_events();
    ASSERT_EQ(events.size(), 1u) << x;
    EXPECT_EQ(events.front().kind, kind) << x;
  }
}

TEST(TriggerVolumes, ObeyFiltersAndEndWhenABodyGoes) {
  Trigger deaf(box(2, 2, 2)), all(box(2, 2, 2));
  ContactWorld w({0, 0, 0});
  w.world.addCollisionObject(&deaf.object(), btBroadphaseProxy::SensorTrigger, 32);
  w.world.addCollisionObject(&all.object(), btBroadphaseProxy::SensorTrigger, -1);
  const SoftBody<3>& body = w.add(make_box({1, 1, 1}, 0.25f), settings_of(0.25f), {0, 0, 0});
  w.bodies.watch_contacts(true);
  w.run(1);
  std::vector<ContactEvent> events = w.bodies.poll_contact_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].object, &all.object());
  w.bodies.remove(body);
  events = w.bodies.poll_contact_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::kEnd);
}

/// Against the distance of a sphere's centre from a box, for spheres of any size anywhere.
TEST(TriggerVolumes, FindWhatGeometryFinds) {
  constexpr float kCell = 0.25f, kDeepEnough = 0.34f * kCell;
  const auto model = make_soft_body_model(make_box({1, 1, 1}, kCell), settings_of(kCell));
  const SoftBody<3> body(model, Vector3f(0, 0, 0));
  const ContactModel contact(model);
  CellFinder cells;
  cells.place(model->lattice(), body.positions());
  std::mt19937 engine(11);
  std::uniform_real_distribution<float> coordinate(-1, 1), size(0.01f, 0.6f);
  int in = 0, out = 0;
  for (int i = 0; i < 4000; ++i) {
    Obstacle sphere;
    sphere.kind = ObstacleKind::kBox;
    sphere.position = {coordinate(engine), coordinate(engine), coordinate(engine)};
    sphere.rounding = size(engine);
    const std::vector<ObstacleEdge> edges{{Vector3f::Zero(), Vector3f::Zero()}};
    sphere.edges = edges;
    const Vector3f beyond = sphere.position.cwiseAbs() - Vector3f::Constant(0.5f);
    const float depth = sphere.rounding - beyond.cwiseMax(0.0f).norm();
    const bool found = find_overlap(body.positions(), contact, cells, sphere).has_value();
    if (depth < -1e-3f) {
      EXPECT_FALSE(found) << i;
      ++out;
    }
    if (depth > kDeepEnough || beyond.maxCoeff() < 0) {
      EXPECT_TRUE(found) << i << ", " << depth << " m deep";
      ++in;
    }
  }
  EXPECT_GT(in, 500);
  EXPECT_GT(out, 500);
}

}  // namespace
}  // namespace softcell::ppu
