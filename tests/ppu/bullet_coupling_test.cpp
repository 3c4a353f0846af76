#include "softcell/bullet/bullet_soft_bodies.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <ostream>
#include <span>
#include <stdexcept>
#include <vector>

#include "ppu/reference/skin_scalar.h"
#include "soft_body_scenes.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/soft_bodies/state_hash.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

SoftBodySettings stiff(float cell_size) {
  return {.cell_size = cell_size, .half_width = 2, .density = 200, .alpha = 1, .damping = 0.3f};
}

class RestsOnFloor : public testing::TestWithParam<int> {};

TEST_P(RestsOnFloor, InShapeAndAtItsHeight) {
  const int cells = GetParam();
  World world;
  world.add_floor();
  const float cell = 0.8f / static_cast<float>(cells);
  SoftBody<3>& body = world.soft.add(block_model(Vector3i::Constant(cells), stiff(cell)), {0, 0.5f, 0});
  float lowest = 1;
  for (int frame = 0; frame < 600; ++frame) {  // it is elastic, and bounces for a while
    world.bullet.step(kFrame, 2);
    lowest = std::min(lowest, body.bounds().low.y());
  }
  EXPECT_GT(lowest, 0) << "a particle's centre went below the floor";
  EXPECT_LT(fastest(body), 0.02f);
  // E / rho = (s/h)^2 alpha w (w+1) / 3: how much a column gives under its weight, with room for its edges.
  const float modulus = 2 * (cell * 120) * (cell * 120);
  const float sag = 9.81f * 0.8f * 0.8f / (2 * modulus);
  EXPECT_LT(body.deformation(), 4 * sag + 0.004f);
  EXPECT_NEAR(body.bounds().low.y(), body.model().contact_radius(), 0.006f);
}

// 125 and 1000 particles.
INSTANTIATE_TEST_SUITE_P(Blocks, RestsOnFloor, testing::Values(4, 9));

double lowest_mesh_vertex(const SoftBodyModel<3>& model, std::span<const Vector3f> x) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const SkinPart& part : model.embedding().parts) {
    for (std::uint32_t g = part.first_group; g < part.first_group + part.group_count; ++g) {
      for (int lane = 0; lane < 4; ++lane) {
        lowest = std::min(lowest, evaluate_reference(model.embedding(), part, g, lane, x).position.y());
      }
    }
  }
  return lowest;
}

TEST(BulletSoftBodies, AMeshNeverDipsIntoTheFloor) {
  World world;
  world.add_floor();
  const auto model = make_soft_body_model(make_sphere(0.6f, 12), stiff(0.2f));
  SoftBody<3>& body = world.soft.add(model, {0, 2, 0});
  double lowest = 1, lowest_vertex = 1;
  std::vector<Vector3f> x(model->particles());
  for (int frame = 0; frame < 900; ++frame) {
    world.bullet.step(kFrame, 2);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = body.position(i);
    lowest_vertex = lowest_mesh_vertex(*model, x);
    lowest = std::min(lowest, lowest_vertex);
  }
  EXPECT_GT(lowest, 0);
  EXPECT_LT(lowest_vertex, 1.2 * 0.2) << "the mesh lies more than a cell above the floor";
}

TEST(BulletSoftBodies, SlideAboutAsFarAsACoulombBlock) {
  constexpr float kFriction = 0.5f, kSpeed = 3;
  World world;
  world.add_floor(1);
  SoftBodySettings settings = stiff(0.2f);
  settings.friction = kFriction;
  SoftBody<3>& body = world.soft.add(block_model({6, 2, 4}, settings), {0, 0.031f, 0});
  world.run(1);
  const float begin = body.centre_of_mass().x();
  body.add_velocity({kSpeed, 0, 0});
  world.run(3);
  const float way = body.centre_of_mass().x() - begin;
  const float coulomb = kSpeed * kSpeed / (2 * kFriction * 9.81f);
  EXPECT_GT(way, coulomb / 1.5f);
  EXPECT_LT(way, coulomb * 1.5f);
  EXPECT_LT(fastest(body), 0.02f);
}

struct Friction {
  float body, floor;
};
void PrintTo(const Friction& friction, std::ostream* out) {
  *out << friction.body << " on " << friction.floor;
}
class SlidingFriction : public testing::TestWithParam<Friction> {};

/// Bullet multiplies the coefficients of what touches: a body that slides is slowed down by that times g.
TEST_P(SlidingFriction, IsTheProductOfBothCoefficients) {
  constexpr float kSpeed = 3, kSeconds = 0.25f, kGravity = 9.81f;
  const auto [of_body, of_floor] = GetParam();
  World world;
  world.add_floor(of_floor);
  SoftBodySettings settings = stiff(0.2f);
  settings.friction = of_body;
  SoftBody<3>& body = world.soft.add(block_model({6, 2, 4}, settings), {-3, 0.031f, 0});
  world.run(2);
  const float before = body.linear_momentum().x();
  body.add_velocity({kSpeed, 0, 0});
  world.run(kSeconds);
  const float mass = std::accumulate(body.model().masses().begin(), body.model().masses().end(), 0.0f);
  const float slowed_by = kSpeed + (before - body.linear_momentum().x()) / mass;
  const float coefficient = slowed_by / (kGravity * kSeconds);
  EXPECT_NEAR(coefficient, of_body * of_floor, 0.01f)
      << "the soft body's friction is " << of_body << ", the floor's " << of_floor;
}

INSTANTIATE_TEST_SUITE_P(Coefficients, SlidingFriction,
                         testing::Values(Friction{0, 1}, Friction{0.1f, 1}, Friction{0.3f, 1},
                                         Friction{0.9f, 1}, Friction{0.6f, 0.5f}, Friction{1, 0.25f}));

TEST(BulletSoftBodies, PushARigidBox) {
  World world;
  world.add_floor(0.2f);
  const std::size_t box = world.bullet.add_box({0.5f, 0.5f, 0.5f}, 10, {1.2f, 0.25f, 0}, 0.5f);
  SoftBody<3>& body = world.soft.add(block_model({4, 3, 4}, stiff(0.2f)), {0, 0.031f, 0});
  body.add_velocity({4, 0, 0});
  world.run(2);
  EXPECT_GT(world.bullet.pose(box)(0, 3), 1.5f);
  EXPECT_NEAR(world.bullet.pose(box)(1, 3), 0.25f, 0.03f);
  EXPECT_LT(body.centre_of_mass().x(), world.bullet.pose(box)(0, 3));
}

TEST(BulletSoftBodies, CarryARigidBox) {
  World world;
  world.add_floor();
  SoftBody<3>& body = world.soft.add(block_model({4, 3, 4}, stiff(0.2f)), {0, 0.031f, 0});
  const std::size_t box = world.bullet.add_box({0.5f, 0.5f, 0.5f}, 25, {0, 1.0f, 0}, 0.6f);
  world.run(4);
  const float top = 3 * 0.2f + 2 * body.model().contact_radius();
  EXPECT_NEAR(world.bullet.pose(box)(1, 3), top + 0.25f, 0.06f);
  EXPECT_LT(fastest(body), 0.03f);
}

/// After the assignment the body has the spheres of the other model.
TEST(BulletSoftBodies, ABodyOfALargerOrSmallerModelCanBeAssigned) {
  const auto small = block_model({2, 2, 2}, stiff(0.1f)), large = block_model({6, 4, 6}, stiff(0.1f));
  for (const auto& [before, after] : {std::pair(small, large), std::pair(large, small)}) {
    World world;
    world.add_floor();
    SoftBody<3>& body = world.soft.add(before, {0, 0.5f, 0});
    for (int frame = 0; frame < 10; ++frame) world.bullet.step(kFrame, 2);
    body = SoftBody<3>(after, {0, 0.5f, 0});
    for (int frame = 0; frame < 180; ++frame) world.bullet.step(kFrame, 2);
    EXPECT_GT(body.bounds().low.y(), 0);
    EXPECT_LT(body.bounds().low.y(), 0.2f);
    EXPECT_EQ(static_cast<std::size_t>(world.bullet.world().getNumCollisionObjects()),
              after->outer().size() + 1);
  }
}

TEST(BulletSoftBodies, SoftBodiesRestOnEachOther) {
  World world;
  world.add_floor();
  SoftBody<3>& lower = world.soft.add(block_model({6, 2, 6}, stiff(0.2f)), {0, 0.05f, 0});
  // Half a cell aside: every particle comes down on the middle of a face, the widest gap.
  SoftBody<3>& upper = world.soft.add(block_model({3, 3, 3}, stiff(0.2f)), {0, 0.65f, 0});
  for (int frame = 0; frame < 300; ++frame) {
    world.bullet.step(kFrame, 2);
    ASSERT_GT(upper.bounds().low.y(), 0.37f) << "frame " << frame << ": it sinks in";
  }
  EXPECT_LT(upper.bounds().low.y(), 0.7f);
  EXPECT_GT(lower.bounds().low.y(), 0);
}

TEST(BulletSoftBodies, DoNotPassThroughEachOther) {
  World world;
  world.bullet.set_gravity({0, 0, 0});
  const auto model = block_model({3, 3, 3}, stiff(0.2f));
  SoftBody<3>& a = world.soft.add(model, {-0.5f, 0, 0});
  SoftBody<3>& b = world.soft.add(model, {0.5f, 0.1f, 0.1f});
  a.add_velocity({5, 0, 0});
  const Vector3f before = a.linear_momentum();
  world.run(1);
  EXPECT_GT(b.centre_of_mass().x() - a.centre_of_mass().x(), 0.6f);
  EXPECT_LT((a.linear_momentum() + b.linear_momentum() - before).norm(), 1e-3f * before.norm());
}

TEST(BulletSoftBodies, ACollisionKeepsTheTotalMomentum) {
  World world;
  world.bullet.set_gravity({0, 0, 0});
  const std::size_t box = world.bullet.add_box({0.6f, 0.6f, 0.6f}, 30, {1.5f, 0.1f, 0.05f}, 0.5f);
  const auto model = make_soft_body_model(make_sphere(0.5f, 8), stiff(0.2f));
  SoftBody<3>& ball = world.soft.add(model, {0, 0, 0});
  ball.add_velocity({5, 0, 0});
  const Vector3f before = ball.linear_momentum();
  world.run(1);
  const auto& rigid =
      *btRigidBody::upcast(world.bullet.world().getCollisionObjectArray()[static_cast<int>(box)]);
  const btVector3 v = rigid.getLinearVelocity();
  const Vector3f of_box = 30 * Vector3f(v.x(), v.y(), v.z());
  EXPECT_GT(of_box.x(), 0.2f * before.x()) << "they did not meet";
  EXPECT_LT((ball.linear_momentum() + of_box - before).norm(), 1e-3f * before.norm());
}

TEST(BulletSoftBodies, WithstandThirtyTimesTheEarthsGravity) {
  World world;
  world.bullet.set_gravity({0, -300, 0});
  world.add_floor();
  SoftBody<3>& body = world.soft.add(block_model({4, 4, 4}, stiff(0.2f)), {0, 0.5f, 0});
  for (int frame = 0; frame < 300; ++frame) {
    world.bullet.step(kFrame, 4);
    ASSERT_GT(body.bounds().low.y(), -0.01f) << "frame " << frame;
    ASSERT_LT(body.bounds().high.y(), 3.0f) << "frame " << frame;
  }
  EXPECT_LT(fastest(body), 1.0f);
  world.bullet.set_gravity({0, -9.81f, 0});
  world.run(2, 4);
  EXPECT_LT(body.deformation(), 0.02f) << "it did not get its shape back";
}

TEST(BulletSoftBodies, AFallFromFarStopsAtTheFloor) {
  for (const int substeps : {1, 2, 4}) {
    World world;
    world.add_floor();
    SoftBody<3>& body = world.soft.add(block_model({3, 3, 3}, stiff(0.2f)), {0, 10, 0});
    float lowest = 1;
    for (int frame = 0; frame < 1200; ++frame) {
      world.bullet.step(kFrame, substeps);
      lowest = std::min(lowest, body.bounds().low.y());
    }
    EXPECT_GT(lowest, 0) << substeps << " substeps";
    EXPECT_LT(body.centre_of_mass().y(), 0.5f) << substeps << " substeps";
  }
}

/// After what was done to it: normal gravity for some seconds, then none.
float deformation_after_a_rest(World& world, const SoftBody<3>& body) {
  world.bullet.set_gravity({0, -9.81f, 0});
  world.run(6, 4);
  world.bullet.set_gravity({0, 0, 0});
  world.run(6, 4);
  return body.deformation();
}

// The report's bodies were stuck after such a fall.
TEST(BulletSoftBodies, AFallOfTenMetresAtAGravityOf300DoesNotGetThemStuck) {
  World world;
  world.bullet.set_gravity({0, -300, 0});
  world.add_floor();
  SoftBody<3>& body = world.soft.add(block_model({4, 4, 4}, stiff(0.2f)), {0, 10, 0});
  world.run(5, 4);
  EXPECT_LT(body.centre_of_mass().y(), 1);
  world.bullet.set_gravity({0, -9.81f, 0});
  world.run(6, 4);
  EXPECT_GT(body.bounds().low.y(), 0) << "it lies on the floor";
  EXPECT_LT(deformation_after_a_rest(world, body), 0.02f) << "it did not get its shape back";
}

// The report's torus collapsed and became a smaller one.
TEST(BulletSoftBodies, AVeryFlexibleTorusGetsItsShapeBack) {
  SoftBodySettings jelly{.cell_size = 0.2f, .half_width = 1, .density = 200, .alpha = 0.02f, .damping = 0.1f};
  const auto torus = make_soft_body_model(make_torus(0.7f, 0.25f, 48, 24), jelly);
  World world;
  world.bullet.set_gravity({0, -300, 0});
  world.add_floor();
  SoftBody<3>& body = world.soft.add(torus, {0, 1, 0});
  world.run(3, 4);
  EXPECT_GT(body.deformation(), 0.3f) << "it was crushed";
  EXPECT_LT(deformation_after_a_rest(world, body), 0.1f) << "half a cell";
}

/// Seconds of a period of the stretching of a block in free space.
double measured_period(float frequency, float step) {
  World world;
  world.bullet.set_gravity({0, 0, 0});
  SoftBodySettings settings = stiff(0.2f);
  settings.half_width = 4;  // one region: each particle swings about a fixed goal
  settings.frequency = frequency;
  settings.damping = 0;
  SoftBody<3>& body = world.soft.add(block_model({2, 2, 2}, settings), {0, 0, 0});
  // Stretched along x by a velocity that keeps centre and orientation.
  const std::uint32_t left = 0;
  const auto right = static_cast<std::uint32_t>(body.model().particles() - 1);
  const float rest = body.position(right).x() - body.position(left).x();
  for (int i = 0; i < world.bullet.world().getNumCollisionObjects(); ++i) {
    auto& particle = *btRigidBody::upcast(world.bullet.world().getCollisionObjectArray()[i]);
    const float x = particle.getWorldTransform().getOrigin().x();
    particle.setLinearVelocity(btVector3(0.3f * x, 0, 0));
  }
  const double h = step;
  double previous = 0, first = 0, last = 0;
  int crossings = 0;
  for (int i = 1; i <= 600; ++i) {
    world.bullet.step(step, 1);
    const double stretch = body.position(right).x() - body.position(left).x() - rest;
    if (i > 1 && previous < 0 && stretch >= 0) {
      last = h * (i - stretch / (stretch - previous));
      if (crossings++ == 0) first = last;
    }
    previous = stretch;
  }
  return (last - first) / (crossings - 1);
}

TEST(BulletSoftBodies, AThrowAtAThinFloorStopsThere) {
  for (const float speed : {30.0f, 60.0f}) {
    World world;
    world.bullet.add_box({20, 0.05f, 20}, 0, {0, -0.025f, 0}, 0.6f);
    SoftBodySettings settings;
    settings.cell_size = 0.2f;
    SoftBody<3>& body = world.soft.add(block_model({4, 4, 4}, settings), {0, 3, 0});
    body.add_velocity({0, -speed, 0});
    world.run(1);
    EXPECT_GT(body.bounds().low.y(), -0.02f) << speed << " m/s";
    world.run(24);  // it bounces, for a dozen seconds higher than itself
    EXPECT_NEAR(body.bounds().low.y(), 0.03f, 0.01f) << "lies on the floor, after " << speed << " m/s";
    EXPECT_LT(body.mean_speed(), 0.5f) << speed << " m/s";
  }
}

TEST(BulletSoftBodies, AFrequencyMeansTheSameForAnyTimeStep) {
  const float frequency = 4;
  EXPECT_NEAR(measured_period(frequency, 1.0f / 60), 0.25, 0.005);
  EXPECT_NEAR(measured_period(frequency, 1.0f / 120), 0.25, 0.005);
}

int g_ticks;
void count_tick(btDynamicsWorld*, btScalar) { ++g_ticks; }

TEST(BulletSoftBodies, ActOncePerSubstepAndCallWhatWasThere) {
  BulletWorld bullet;
  bullet.set_gravity({0, 0, 0});
  int users = 0;
  bullet.world().setInternalTickCallback(&count_tick, &users, true);
  g_ticks = 0;
  std::optional<BulletSoftBodies> soft(bullet.world());
  SoftBodySettings settings = stiff(0.2f);
  settings.damping = 1;  // takes a tenth of nothing: rigid motion stays
  settings.alpha = 0;
  SoftBody<3>& body = soft->add(block_model({2, 2, 2}, settings), {0, 0, 0});
  body.add_velocity({1, 0, 0});
  bullet.step(kFrame, 3);
  EXPECT_EQ(g_ticks, 3);
  // A caller's own way of stepping, with substeps of Bullet's choice.
  bullet.world().stepSimulation(1.0f / 30, 8, 1.0f / 120);
  EXPECT_EQ(g_ticks, 7);
  EXPECT_EQ(bullet.world().getWorldUserInfo(), &users);
  EXPECT_NEAR(body.centre_of_mass().x(), kFrame + 1.0f / 30, 1e-5f);
  soft.reset();
  EXPECT_EQ(bullet.world().getNumCollisionObjects(), 0);
  bullet.step(kFrame, 1);
  EXPECT_EQ(g_ticks, 8);
}

std::optional<BulletSoftBodies>* g_destroyed_in_tick = nullptr;
void destroy_soft_bodies(btDynamicsWorld*, btScalar) { g_destroyed_in_tick->reset(); }

/// A program may load its next level there.
TEST(BulletSoftBodies, MayBeDestroyedInTheProgramsOwnTick) {
  BulletWorld bullet;
  bullet.world().setInternalTickCallback(&destroy_soft_bodies, nullptr, true);
  std::optional<BulletSoftBodies> soft(bullet.world());
  g_destroyed_in_tick = &soft;
  soft->add(block_model({2, 2, 2}, stiff(0.2f)), {0, 0, 0});
  bullet.step(kFrame, 2);
  EXPECT_FALSE(soft);
  EXPECT_EQ(bullet.world().getNumCollisionObjects(), 0);
}

TEST(BulletSoftBodies, TheLengthOfTheSubstepCounts) {
  // Half a pull's way in one step is alpha (g - x) / h: after one step of any length a particle that was 1 cm
  // off in a body of one region is alpha cm nearer.
  for (const float step : {1.0f / 60, 1.0f / 240}) {
    World world;
    world.bullet.set_gravity({0, 0, 0});
    SoftBodySettings settings = stiff(0.2f);
    settings.half_width = 4;
    settings.alpha = 0.5f;
    settings.damping = 0;
    SoftBody<3>& body = world.soft.add(block_model({4, 4, 4}, settings), {0, 0, 0});
    auto& particle = *btRigidBody::upcast(world.bullet.world().getCollisionObjectArray()[0]);
    const Vector3f rest = body.position(0);
    particle.getWorldTransform().getOrigin() += btVector3(0.01f, 0, 0);
    world.bullet.step(step, 1);
    // 5 mm, less what the whole body follows: its region's weight is spread over 125 particles.
    EXPECT_NEAR(body.position(0).x() - rest.x(), 0.005f, 0.0005f) << step;
  }
}

struct RefuseAll final : btOverlapFilterCallback {
  bool needBroadphaseCollision(btBroadphaseProxy*, btBroadphaseProxy*) const override { return false; }
};

TEST(BulletSoftBodies, AnOverlapFilterThatWasThereStillCounts) {
  BulletWorld bullet;
  RefuseAll refuse;
  bullet.world().getPairCache()->setOverlapFilterCallback(&refuse);
  {
    BulletSoftBodies soft(bullet.world(), ContactMethod::kSpheres);
    bullet.add_box({20, 1, 20}, 0, {0, -0.5f, 0}, 0.6f);
    SoftBody<3>& body = soft.add(block_model({2, 2, 2}, stiff(0.2f)), {0, 0.1f, 0});
    for (int i = 0; i < 60; ++i) bullet.step(kFrame, 2);
    EXPECT_LT(body.centre_of_mass().y(), -1) << "the floor should not have held it";
  }
  EXPECT_EQ(bullet.world().getPairCache()->getOverlapFilterCallback(), &refuse);
}

TEST(BulletSoftBodies, NoContactsWithinABody) {
  World world;
  world.bullet.set_gravity({0, 0, 0});
  SoftBody<3>& body = world.soft.add(block_model({4, 4, 4}, stiff(0.01f)), {0, 0, 0});
  world.run(0.1f);
  EXPECT_EQ(world.bullet.world().getPairCache()->getNumOverlappingPairs(), 0);
  const auto& object = *world.bullet.world().getCollisionObjectArray()[3];
  EXPECT_EQ(BulletSoftBodies::particle_of(object).body, &body);
  EXPECT_EQ(BulletSoftBodies::particle_of(object).number, body.model().outer()[3]);
}

TEST(BulletSoftBodies, ATeleportIsToldToBullet) {
  World world;
  world.add_floor();
  SoftBody<3>& body = world.soft.add(block_model({3, 3, 3}, stiff(0.2f)), {0, 0.05f, 0});
  world.run(1);
  const Vector3f before = body.centre_of_mass();
  body.move_without_force(Eigen::Quaternionf(Eigen::AngleAxisf(0.7f, Vector3f::UnitY())), {3, 0.5f, -2});
  world.bullet.step(kFrame, 2);
  EXPECT_LT((body.centre_of_mass() - before - Vector3f(3, 0.5f, -2)).norm(), 0.02f);
  EXPECT_LT(body.deformation(), 0.02f);
  world.run(2);
  EXPECT_NEAR(body.bounds().low.y(), body.model().contact_radius(), 0.01f);
}

/// The PPU's solver, which keeps a record of what it is to forget.
class RecordingSolver final : public SoftBodySolver<3> {
 public:
  void kick(std::span<SoftBody<3>* const> bodies, float step) override { ppu_.kick(bodies, step); }
  void finish() override { ppu_.finish(); }
  void drop() override { ppu_.drop(); }
  void forget(const SoftBody<3>& body) override { forgotten.push_back(&body); }

  std::vector<const SoftBody<3>*> forgotten;

 private:
  PpuSolver<3> ppu_;
};

TEST(BulletSoftBodies, OnlyATeleportMakesTheSolverForget) {
  BulletWorld bullet;
  RecordingSolver solver;
  BulletSoftBodies soft(bullet.world(), solver);
  SoftBody<3>& body = soft.add(block_model({3, 3, 3}, stiff(0.2f)), {0, 0, 0});
  bullet.step(kFrame, 2);
  body.add_velocity({1, 0, 0});
  body.add_particle_velocity(0, {0, 1, 0});
  body.translate({0, 1, 0});
  bullet.step(kFrame, 2);
  EXPECT_TRUE(solver.forgotten.empty());
  body.move_without_force(Eigen::Quaternionf(0, 1, 0, 0), {0, 0, 0});
  bullet.step(kFrame, 2);
  EXPECT_EQ(solver.forgotten, std::vector<const SoftBody<3>*>{&body});
}

/// A contact that goes on is warm-started with the impulse of the substep before.
TEST(BulletSoftBodies, APushLeavesContactsAlone) {
  World world;
  world.add_floor();
  SoftBody<3>& body = world.soft.add(block_model({3, 3, 3}, stiff(0.2f)), {0, 0.05f, 0});
  world.run(1);
  const auto lasting = [&] {
    int sum = 0;
    btDispatcher& dispatcher = *world.bullet.world().getDispatcher();
    for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
      const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
      for (int p = 0; p < manifold.getNumContacts(); ++p)
        sum += manifold.getContactPoint(p).getLifeTime() > 2 ? 1 : 0;
    }
    return sum;
  };
  const int before = lasting();
  ASSERT_GT(before, 0);
  body.add_particle_velocity(body.model().outer()[0], {0, 0, 1e-6f});
  world.bullet.step(kFrame, 2);
  EXPECT_GE(lasting(), before);
}

TEST(BulletSoftBodies, ASavedBodyIsRestoredAsAWhole) {
  World world;
  SoftBody<3>& body = world.soft.add(block_model({4, 4, 4}, stiff(0.2f)), {0, 9, 0});
  world.run(0.5f);
  const SoftBody<3> saved = body;
  world.run(0.5f);
  body = saved;
  EXPECT_NE(body.revision(), saved.revision());
  world.bullet.step(kFrame, 2);
  for (std::size_t i = 0; i < body.model().particles(); ++i)
    ASSERT_LT((body.position(i) - saved.position(i)).norm(), 6 * kFrame) << i;
  EXPECT_LT(body.deformation(), 1e-3f);
}

/// A saved game may have been saved while bodies were in the air.
TEST(BulletSoftBodies, ASleeperWhoseStateIsSetInTheAirFalls) {
  for (const ContactMethod contacts : {ContactMethod::kSurface, ContactMethod::kSpheres}) {
    BulletWorld bullet;
    BulletSoftBodies soft(bullet.world(), contacts);
    bullet.add_box({20, 1, 20}, 0, {0, -0.5f, 0}, 0.6f);
    soft.let_sleep(SleepSettings{.speed = 0.5f, .seconds = 0.2f});
    SoftBody<3>& body = soft.add(block_model({3, 3, 3}, stiff(0.2f)), {0, 0.35f, 0});
    for (int i = 0; i < 240 && !body.asleep(); ++i) bullet.step(kFrame, 2);
    ASSERT_TRUE(body.asleep());
    const float lain = body.bounds().low.y();
    std::vector<Vector3f> raised(body.positions().begin(), body.positions().end());
    for (Vector3f& position : raised) position.y() += 0.5f;
    body.set_state(raised, std::vector<Vector3f>(raised.size(), Vector3f::Zero()));
    for (int i = 0; i < 120; ++i) bullet.step(kFrame, 2);
    EXPECT_NEAR(body.bounds().low.y(), lain, 0.02f);
  }
}

TEST(BulletSoftBodies, WhatSleptOnABodyFallsWhenThatGoesAway) {
  const auto fine = block_model({3, 3, 3}, stiff(0.2f)), coarse = block_model({3, 3, 3}, stiff(0.5f));
  for (const auto& below : {fine, coarse}) {
    for (const bool removed : {true, false}) {
      World world;
      world.add_floor();
      world.soft.let_sleep(SleepSettings{.speed = 0.5f, .seconds = 0.2f});
      SoftBody<3>& low = world.soft.add(below, {0, 0.05f, 0});
      // Above one of its particles, as far away as the two can be.
      const float height = low.bounds().high.y();
      SoftBody<3>& high = world.soft.add(
          fine, {0, height + 1.05f * (fine->soft_contact_radius() + below->soft_contact_radius()), 0});
      world.run(4);
      ASSERT_TRUE(low.asleep() && high.asleep());
      if (removed)
        world.soft.remove(low);
      else
        low.translate({9, 0, 0});
      world.run(4);
      EXPECT_NEAR(high.bounds().low.y(), fine->contact_radius(), 0.02f) << removed;
    }
  }
}

TEST(BulletSoftBodies, CanBeRemovedOneByOne) {
  World world;
  world.add_floor();
  const auto model = block_model({2, 2, 2}, stiff(0.2f));
  SoftBody<3>& a = world.soft.add(model, {0, 0.05f, 0});
  SoftBody<3>& b = world.soft.add(model, {0, 0.8f, 0});
  world.run(1);
  world.soft.remove(a);
  EXPECT_EQ(world.soft.size(), 1u);
  EXPECT_THROW(world.soft.remove(a), std::invalid_argument);
  world.run(2);
  EXPECT_NEAR(b.bounds().low.y(), model->contact_radius(), 0.01f) << "what held it is gone";
}

TEST(BulletSoftBodies, RefuseNumbersOutOfTheirRange) {
  World world;
  SoftBody<3>& body = world.soft.add(block_model({1, 1, 1}, stiff(0.2f)), {0, 0, 0});
  EXPECT_EQ(&world.soft[0], &body);
  try {
    static_cast<void>(world.soft[9]);
    FAIL() << "there is one body";
  } catch (const std::out_of_range& error) {
    EXPECT_STREQ(error.what(), "soft body 9 of a world of 1; the first one is 0");
  }
  for (const float wrong : {-1.0f, NAN}) {
    EXPECT_THROW(world.soft.let_sleep(SleepSettings{.speed = wrong}), std::invalid_argument);
    EXPECT_THROW(world.soft.let_sleep(SleepSettings{.seconds = wrong}), std::invalid_argument);
    EXPECT_THROW(world.soft.begin_ahead(wrong), std::invalid_argument);
  }
  EXPECT_NO_THROW(world.soft.begin_ahead(0)) << "it begins nothing";
}

TEST(BulletSoftBodies, ANanIsReported) {
  World world;
  SoftBody<3>& body = world.soft.add(block_model({2, 2, 2}, stiff(0.2f)), {0, 0.05f, 0});
  body.set_velocity(0, {NAN, 0, 0});
  body.add_velocity({0, 0, 0});  // tells the coupling of the change
  EXPECT_THROW(world.run(0.1f), std::runtime_error);
}

std::uint64_t hash_of_a_run() {
  World world;
  world.add_floor();
  world.bullet.add_box({0.4f, 0.4f, 0.4f}, 10, {0.1f, 1.6f, 0}, 0.6f);
  const auto ball = make_soft_body_model(make_sphere(0.5f, 8), stiff(0.2f));
  const SoftBody<3>* bodies[] = {&world.soft.add(ball, {0, 0.8f, 0}),
                                 &world.soft.add(ball, {0.3f, 2.2f, 0.1f})};
  world.run(2);
  return state_hash(bodies);
}

TEST(BulletSoftBodies, TwoRunsGiveTheSameBytes) { EXPECT_EQ(hash_of_a_run(), hash_of_a_run()); }

TEST(BulletWorld, TakesTheSoftBodiesTimeOutOfBullets) {
  World world;
  world.add_floor();
  world.soft.add(block_model({6, 6, 6}, stiff(0.2f)), {0, 0.05f, 0});
  const StepTimes times = world.bullet.step(kFrame, 2);
  EXPECT_GT(times.soft_body_ms, 0);
  EXPECT_GT(times.physics_ms, 0);
}

TEST(BulletWorld, RefusesWhatMakesNoSense) {
  BulletWorld world;
  EXPECT_THROW(world.add_box({1, 0, 1}, 0, {0, 0, 0}, 0.5f), std::invalid_argument);
  EXPECT_THROW(world.add_box({1, 1, 1}, -1, {0, 0, 0}, 0.5f), std::invalid_argument);
  EXPECT_THROW(world.add_convex({}, {0, 0, 0}, 0.5f), std::invalid_argument);
  EXPECT_THROW(world.step(0, 1), std::invalid_argument);
  EXPECT_THROW(world.step(kFrame, 0), std::invalid_argument);
}

}  // namespace
}  // namespace softcell::ppu
