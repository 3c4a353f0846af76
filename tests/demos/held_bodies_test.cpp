// Hands that hold bodies in three dimensions: they lift, carry and throw whatever they touch, and tear nothing.
// SOFTCELL_RANDOM_DRAGS=1000 build/release/simulation_tests --gtest_filter=*Drags* drags more often.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "grips/hand_patch.h"
#include "input/recording.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/soft_bodies/skinned_mesh.h"
#include "support/slow_build.h"

namespace softcell::demos {
namespace {

using Eigen::Vector3f;
using Events = std::vector<InputEvent<3>>;

constexpr float kFramesASecond = 60;

InputEvent<3> users(Action action, const Vector3f& at) {
  InputEvent<3> event;
  event.action = action;
  event.hand = kUsersHand;
  event.value = at;
  return event;
}

/// The user's hand in a simulation.
class User {
 public:
  explicit User(Simulation3d& simulation) : simulation_(simulation) {}

  const Vector3f& at() const { return at_; }

  /// Takes what a ray meets. @return whether there was something
  bool take(const Ray& ray) {
    auto taken = simulation_.touch(ray);
    if (!taken) return false;
    at_ = taken->value;
    taken->hand = kUsersHand;
    step(*taken);
    return true;
  }
  /// Moves evenly for so many frames.
  template <class AfterFrame>
  void move(const Vector3f& velocity, int frames, const AfterFrame& after_frame) {
    for (int frame = 0; frame < frames; ++frame) {
      at_ += velocity / kFramesASecond;
      step(users(Action::kMoveHand, at_));
      after_frame();
    }
  }
  void move(const Vector3f& velocity, int frames) {
    move(velocity, frames, [] {});
  }
  void release() { step(users(Action::kRelease, {0, 0, 0})); }

 private:
  void step(const InputEvent<3>& event) { simulation_.step({&event, 1}); }

  Simulation3d& simulation_;
  Vector3f at_{0, 0, 0};
};

void reset(Simulation3d& simulation) {
  const InputEvent<3> event = users(Action::kReset, {0, 0, 0});
  simulation.step({&event, 1});
}

/// The least volume of a cell, measured at its middle, as a share of its volume at rest; below 0: inside out.
float least_volume(const ppu::SoftBody<3>& body) {
  const ppu::Lattice<3>& lattice = body.model().lattice();
  float least = std::numeric_limits<float>::infinity();
  for (const auto& corners : lattice.corners) {
    Eigen::Matrix3f edges = Eigen::Matrix3f::Zero();
    for (std::size_t k = 0; k < 8; ++k) {
      for (int axis = 0; axis < 3; ++axis)
        edges.col(axis) += (((k >> axis) & 1) != 0 ? 0.25f : -0.25f) * body.position(corners[k]);
    }
    least = std::min(least, edges.determinant() / std::pow(lattice.spacing, 3.0f));
  }
  return least;
}

Vector3f velocity_of(const ppu::SoftBody<3>& body) { return body.linear_momentum() / body.model().mass(); }
Vector3f size_of(const ppu::SoftBody<3>& body) { return body.bounds().high - body.bounds().low; }

/// Downwards onto the body from above its middle, or as near beside it as there is something: a ring has a hole.
bool take_from_above(User& user, const ppu::SoftBody<3>& body) {
  const Vector3f low = body.bounds().low, size = size_of(body);
  for (const float x : {0.5f, 0.8f, 0.2f, 0.1f, 0.9f}) {
    for (const float z : {0.5f, 0.8f, 0.2f}) {
      const Vector3f above = low + Vector3f(x * size.x(), 2 * size.y(), z * size.z());
      if (user.take({.from = above, .along = -Vector3f::UnitY()})) return true;
    }
  }
  return false;
}

struct Held {
  const char* name;
  ppu::TriangleMesh mesh;
  float cells;  // along its longest side
};
void PrintTo(const Held& held, std::ostream* out) { *out << held.name << ", " << held.cells << " cells"; }

/// The scene drop with the model standing on the floor.
Scene standing(const Held& held) {
  const ppu::Bounds<3> box = ppu::bounds(held.mesh);
  Scene scene = load_scene_3d(
      "drop", OwnModel{.mesh = held.mesh, .cell_size = (box.high - box.low).maxCoeff() / held.cells});
  SoftBodyPlacement& body = scene.soft_bodies.front();
  body.position.y() = 0.01f - ppu::bounds(body.mesh).low.y();
  return scene;
}

class HeldBody : public testing::TestWithParam<Held> {};

TEST_P(HeldBody, IsLiftedCarriedAndThrownAndNotTorn) {
  if (kSlowBuild && GetParam().cells > 14)
    GTEST_SKIP() << "too slow with sanitizers, which run the small bodies";
  const Scene scene = standing(GetParam());
  Simulation3d simulation(scene, {.spes = 2});
  const ppu::SoftBody<3>& body = simulation.soft_body(0);
  for (int frame = 0; frame < 60; ++frame) simulation.step();
  const float size = size_of(body).maxCoeff(), lowest = body.bounds().low.y();
  float least = least_volume(body);
  ASSERT_GT(least, 0) << "the body does not stand by itself";
  const auto look = [&] { least = std::min(least, least_volume(body)); };

  User user(simulation);
  ASSERT_TRUE(take_from_above(user, body));
  constexpr int kLift = 17;  // frames, 0.3 s with the one in which it was taken
  user.move({0, size * kFramesASecond / kLift, 0}, kLift, look);
  EXPECT_GT(body.bounds().low.y(), lowest + 0.1f * size)
      << "not lifted within 0.3 s, by a hand that rises " << size;

  user.move({0, 0, 0}, 30, look);
  const float hangs = user.at().y() - body.centre_of_mass().y();
  EXPECT_LT(std::abs(hangs), size) << "the hand lifts the body to where it is";

  const Vector3f pointer(3, 0, 1);
  user.move(pointer, 30, look);
  EXPECT_LT((user.at() - body.centre_of_mass()).norm(), 1.5f * size) << "left behind";
  user.release();
  const Vector3f thrown = velocity_of(body);
  EXPECT_LT((Vector3f(thrown.x(), 0, thrown.z()) - pointer).norm(), 0.2f * pointer.norm())
      << "(" << thrown.x() << ", " << thrown.z() << ") m/s";
  for (int frame = 0; frame < 10; ++frame) simulation.step(), look();
  EXPECT_GT(least, 0) << "a cell was turned inside out";
}

/// All are as stiff as the scene has it, so large ones of fine cells, which would be softer, are bodies that stand.
std::vector<Held> held_bodies() {
  return {{"ball", ppu::make_sphere(0.5f, 16), 6},
          {"ball", ppu::make_sphere(0.5f, 16), 14},
          {"torus", ppu::make_torus(0.7f, 0.25f, 48, 24), 6},
          {"torus", ppu::make_torus(0.7f, 0.25f, 48, 24), 20},
          {"car", ppu::make_car(1.5f), 6},
          {"car", ppu::make_car(1.5f), 20},
          {"penguin", ppu::make_penguin(1.2f), 8},
          {"penguin", ppu::make_penguin(1.2f), 12},
          {"box", ppu::make_box({1, 0.6f, 0.8f}, 0.1f), 31}};
}
INSTANTIATE_TEST_SUITE_P(Bodies, HeldBody, testing::ValuesIn(held_bodies()));

TEST(HeldBodies, AreThrownAtThePointersSpeed) {
  const Scene scene = standing({"ball", ppu::make_sphere(0.5f, 16), 8});
  Simulation3d simulation(scene, {.spes = 2});
  const ppu::SoftBody<3>& body = simulation.soft_body(0);
  for (const float speed : {0.5f, 1.0f, 2.0f, 5.0f, 9.0f}) {
    for (const int frames : {10, 20, 40}) {  // a flick, and a walk
      reset(simulation);
      User user(simulation);
      ASSERT_TRUE(take_from_above(user, body));
      user.move({0, 2, 0}, 30);
      user.move({0, 0, 0}, 30);
      user.move({speed, 0, 0}, frames);
      user.release();
      EXPECT_NEAR(velocity_of(body).x(), speed, 0.2f * speed) << frames << " frames";
      EXPECT_NEAR(velocity_of(body).z(), 0, 0.2f * speed) << frames << " frames";
    }
  }
}

TEST(HeldBodies, AHandThatStaysLetsThemHangStill) {
  const Scene scene = standing({"penguin", ppu::make_penguin(1.2f), 8});
  Simulation3d simulation(scene, {.spes = 2});
  User user(simulation);
  ASSERT_TRUE(take_from_above(user, simulation.soft_body(0)));
  user.move({0, 3, 0}, 20);
  user.move({0, 0, 0}, 120);
  EXPECT_LT(velocity_of(simulation.soft_body(0)).norm(), 0.1f);
  Shown3d shown;
  simulation.finish();
  simulation.show(shown);
  ASSERT_EQ(shown.hands.size(), 1u);
  EXPECT_EQ(shown.hands[0][1], user.at());
  EXPECT_LT((shown.hands[0][0] - user.at()).norm(), 0.05f) << "the held point is where the hand is";
}

TEST(HeldBodies, AHandIsNoStrongerThanItSays) {
  const Scene scene = standing({"ball", ppu::make_sphere(0.5f, 16), 8});
  Simulation3d simulation(scene, {.spes = 2});
  const ppu::SoftBody<3>& body = simulation.soft_body(0);
  User user(simulation);
  ASSERT_TRUE(take_from_above(user, body));
  const Vector3f before = velocity_of(body);
  user.move({0, 60'000, 0}, 1);
  // 40 m/s^2 and twice gravity, by the impulse and by what stops swinging, less gravity.
  const float most = (2 * (40 + 2 * 9.81f) - 9.81f) / kFramesASecond;
  EXPECT_LE((velocity_of(body) - before).norm(), 1.01f * most);
  user.move({0, 60'000, 0}, 60);
  EXPECT_LT(velocity_of(body).norm(), 40) << "the speed is limited, too";
  EXPECT_TRUE(body.bounds().low.allFinite());
}

/// A cone with a ring around it.
Scene cone_scene() {
  Scene scene;
  scene.name = "cone";
  scene.boxes = {{.size = {20, 1, 20}, .position = {0, -0.5f, 0}}};
  SoftBodyPlacement cone, ring;
  cone.mesh = ppu::make_cone(0.6f, 1.2f, 32);
  cone.settings = {.cell_size = 0.12f, .half_width = 3, .alpha = 0.9f, .damping = 0.2f};
  cone.position = {0, 0.62f, 0};
  ring.mesh = ppu::make_torus(0.4f, 0.12f, 32, 12);
  ring.settings = {.cell_size = 0.12f, .half_width = 2, .alpha = 0.9f, .damping = 0.2f};
  ring.position = {0, 0.65f, 0};
  scene.soft_bodies = {cone, ring};
  return scene;
}

TEST(HeldBodies, AHandCarriesWhatStandsOnTheBodyThatItHolds) {
  const Scene scene = cone_scene();
  Simulation3d simulation(scene, {.spes = 2});
  for (int frame = 0; frame < 60; ++frame) simulation.step();
  const ppu::SoftBody<3>&cone = simulation.soft_body(0), &ring = simulation.soft_body(1);
  const Vector3f before = ring.centre_of_mass();
  ASSERT_GT(before.y(), 0.3f) << "it lies on the cone, not on the floor";
  User user(simulation);
  ASSERT_TRUE(user.take({.from = {0.01f, 5, 0.01f}, .along = -Vector3f::UnitY()}));
  ASSERT_GT(user.at().y(), 1) << "the cone's tip";
  user.move({0, 2, 0}, 30);
  user.move({0, 0, 0}, 240);
  EXPECT_NEAR(ring.centre_of_mass().y(), before.y() + 1, 0.2f) << "it is lifted, too";
  EXPECT_LT(velocity_of(cone).norm() + velocity_of(ring).norm(), 0.1f) << "both hang still";
  Shown3d shown;
  simulation.finish();
  simulation.show(shown);
  ASSERT_EQ(shown.hands.size(), 1u);
  EXPECT_LT((shown.hands[0][0] - user.at()).norm(), 0.05f) << "as near as with the cone alone";
}

/// A hand pulls a body against the floor as hard as it can.
TEST(HeldBodies, AHandPressesNothingIntoTheFloor) {
  for (const float cells : {6.0f, 10.0f}) {
    const Scene scene = standing({"ball", ppu::make_sphere(0.5f, 16), cells});
    const float cell = scene.soft_bodies[0].settings.cell_size;
    Simulation3d simulation(scene, {.spes = 2});
    const ppu::SoftBody<3>& body = simulation.soft_body(0);
    User user(simulation);
    ASSERT_TRUE(take_from_above(user, body));
    float deepest = 0;
    ppu::SkinnedMesh skin(body.shared_model());
    const auto look = [&] {
      skin.update(body);
      for (const Vector3f& vertex : skin.positions()) deepest = std::min(deepest, vertex.y());
    };
    user.move({0, -6, 0}, 30, look);
    user.move({0, 0, 0}, 60, look);
    EXPECT_GT(deepest, -0.1f * cell) << cells << " cells";
    EXPECT_GT(least_volume(body), -0.5f) << cells << " cells";
    user.release();
    for (int frame = 0; frame < 120; ++frame) simulation.step();
    EXPECT_LT(body.deformation(), 0.5f * cell + 0.1f) << cells << " cells";
  }
}

/// A heavy box on a floor, behind it a soft ball, and a wall beside them.
Scene rigid_scene(float wall_opacity) {
  Scene scene;
  scene.name = "rigid";
  scene.boxes = {{.size = {20, 1, 20}, .position = {0, -0.5f, 0}},
                 {.size = {1, 0.8f, 0.6f}, .mass = 70, .position = {0, 0.41f, 0}},
                 {.size = {10, 4, 0.2f}, .position = {0, 2, 3}, .opacity = wall_opacity}};
  SoftBodyPlacement ball;
  ball.mesh = ppu::make_sphere(0.4f, 8);
  ball.settings.cell_size = 0.2f;
  ball.position = {0, 0.42f, -2};
  scene.soft_bodies.push_back(ball);
  return scene;
}

TEST(HeldBodies, RigidOnesAreLiftedAndThrown) {
  const Scene scene = rigid_scene(1);
  Simulation3d simulation(scene, {.spes = 2});
  for (int frame = 0; frame < 20; ++frame) simulation.step();
  User user(simulation);
  ASSERT_TRUE(user.take({.from = {0.4f, 5, 0.2f}, .along = -Vector3f::UnitY()})) << "near a corner";
  EXPECT_NEAR(user.at().y(), 0.8f, 0.03f);
  const auto position = [&] {
    simulation.finish();
    return Vector3f(simulation.shown_box_poses()[1].topRightCorner<3, 1>());
  };
  user.move({0, 3, 0}, 18);
  EXPECT_GT(position().y(), 0.8f);
  user.move({0, 0, 0}, 60);
  EXPECT_LT(position().y(), user.at().y() - 0.3f) << "it hangs from the hand";
  user.move({4, 0, 0}, 30);
  user.release();
  const Vector3f before = position();
  simulation.step();
  EXPECT_NEAR((position() - before).x() * kFramesASecond, 4, 0.8f);
  reset(simulation);
  EXPECT_NEAR(position().y(), 0.41f, 0.01f) << "nobody holds it";
}

TEST(HeldBodies, ARayTakesTheFirstThatMovesUnlessAWallHidesIt) {
  for (const float opacity : {1.0f, 0.15f}) {
    const Scene scene = rigid_scene(opacity);
    const Simulation3d simulation(scene, {.spes = 1});
    const auto along_z = [&](float x, float z, float direction) {
      return simulation.touch({.from = {x, 0.4f, z}, .along = {0, 0, direction}});
    };
    const auto box = along_z(0, 2, -1);
    ASSERT_TRUE(box);
    EXPECT_EQ(box->action, Action::kHoldRigid);
    EXPECT_EQ(box->body, 1u) << "its number among the scene's boxes";
    EXPECT_NEAR(box->value.z(), 0.3f, 0.05f);
    const auto ball = along_z(0, -5, 1);
    ASSERT_TRUE(ball);
    EXPECT_EQ(ball->action, Action::kHold);
    EXPECT_EQ(ball->body, 0u);
    EXPECT_NEAR(ball->value.z(), -2.4f, 0.02f);
    EXPECT_EQ(along_z(0, 5, -1).has_value(), opacity < 0.5f) << "behind a wall of opacity " << opacity;
    EXPECT_FALSE(along_z(3, 2, -1)) << "nothing is there";
    EXPECT_FALSE(simulation.touch({.from = {3, 5, 0}, .along = -Vector3f::UnitY()}))
        << "the floor does not move";
  }
}

/// What is bent for good hangs from the hand as it is bent.
TEST(HeldBodies, AHandKnowsTheShapeOfWhatHasYielded) {
  ppu::SoftBody<3> body(ppu::make_soft_body_model(ppu::make_box({1, 0.4f, 0.4f}, 0.1f),
                                                  {.cell_size = 0.1f, .plasticity = ppu::Plasticity{}}));
  HeldRest<3> rest(body);
  const std::vector<Vector3f> straight = rest.positions;
  std::vector<Vector3f> bent = straight;
  for (Vector3f& x : bent) x.y() += 0.3f * x.x() * x.x();
  body.set_rest_positions(bent);
  EXPECT_EQ(rest.positions, straight);
  rest.renew(body);
  EXPECT_EQ(rest.positions, body.rest_positions());
  EXPECT_GT((rest.positions.front() - straight.front() -
             (rest.positions[straight.size() / 2] - straight[straight.size() / 2]))
                .norm(),
            0.03f);
  Eigen::Vector3d centre(0, 0, 0);
  for (const Vector3f& x : rest.positions) centre += x.cast<double>();
  EXPECT_LT((rest.centre - centre / static_cast<double>(straight.size())).norm(), 0.05);
  body.reset_deformation();
  rest.renew(body);
  EXPECT_EQ(rest.positions, straight);
}

TEST(HeldBodies, NoHandHoldsWhatIsNotThere) {
  const Scene scene = rigid_scene(1);
  Simulation3d held(scene, {.spes = 1}), left(scene, {.spes = 1});
  const Events nothing{{.action = Action::kHold, .hand = 0, .body = 7, .value = {0, 0, 0}},
                       {.action = Action::kHoldRigid, .hand = 1, .body = 0, .value = {0, 0, 0}},
                       {.action = Action::kHoldRigid, .hand = 2, .body = 99, .value = {0, 0, 0}},
                       {.action = Action::kMoveHand, .hand = 1, .value = {0, 9, 0}}};
  held.step(nothing);
  left.step();
  for (int frame = 0; frame < 10; ++frame) held.step(), left.step();
  EXPECT_EQ(held.state_hash(), left.state_hash());
}

TEST(HeldBodies, AHandThatIsSentOutOfTheWorldBreaksNothing) {
  const Scene scene = rigid_scene(1);
  Simulation3d simulation(scene, {.spes = 1});
  constexpr float kFar = std::numeric_limits<float>::max();
  InputEvent<3> hold = users(Action::kHold, {kFar, -kFar, kFar}),
                rigid = users(Action::kHoldRigid, {kFar, -kFar, kFar});
  rigid.hand = 3;
  rigid.body = 1;
  simulation.step({&hold, 1});
  simulation.step({&rigid, 1});
  for (const float sign : {1.0f, -1.0f, 1.0f}) {
    for (const std::uint32_t hand : {kUsersHand, 3u}) {
      InputEvent<3> move = users(Action::kMoveHand, sign * Vector3f(kFar, kFar, -kFar));
      move.hand = hand;
      simulation.step({&move, 1});
    }
    for (int frame = 0; frame < 5; ++frame) simulation.step();
  }
  EXPECT_TRUE(simulation.soft_body(0).bounds().low.allFinite());
  EXPECT_LT(velocity_of(simulation.soft_body(0)).norm(), 40);
  simulation.finish();
  EXPECT_TRUE(simulation.shown_box_poses()[1].allFinite());
}

/// A wild user.
class RandomDrags {
 public:
  explicit RandomDrags(std::uint32_t seed) : random_(seed) {}

  float between(float low, float high) {
    return low + (high - low) * static_cast<float>(random_() >> 8) / float{1 << 24};
  }
  Vector3f vector(float most) { return {between(-most, most), between(-most, most), between(-most, most)}; }

  /// Takes a body from anywhere and drags it about, up to 15 m/s fast, through floor and walls if it would let him.
  void drag(Simulation3d& simulation) {
    reset(simulation);
    const Scene& scene = scene_;
    User user(simulation);
    for (int attempt = 0; attempt < 50; ++attempt) {
      const auto body = static_cast<std::size_t>(between(0, static_cast<float>(scene.soft_bodies.size())));
      const Vector3f from = vector(4) + Vector3f(0, 6, 0);
      const auto positions = simulation.soft_body(body).positions();
      const auto aim = static_cast<std::size_t>(between(0, static_cast<float>(positions.size())));
      if (user.take({.from = from, .along = (positions[aim] - from).normalized()})) break;
    }
    for (int leg = 0; leg < 4; ++leg)
      user.move(vector(1).normalized() * between(0, 15), static_cast<int>(between(2, 16)));
    user.release();
    for (int frame = 0; frame < 30; ++frame) simulation.step();
  }

  const Scene& scene() const { return scene_; }

 private:
  static Scene make_scene() {
    Scene scene = rigid_scene(1);
    const auto add = [&](ppu::TriangleMesh mesh, float cell_size, const Vector3f& position) {
      SoftBodyPlacement body;
      body.mesh = std::move(mesh);
      body.settings.cell_size = cell_size;
      body.position = position;
      scene.soft_bodies.push_back(std::move(body));
    };
    add(ppu::make_penguin(1), 0.12f, {1.5f, 0.52f, 0});
    add(ppu::make_torus(0.5f, 0.2f, 32, 16), 0.2f, {-1.5f, 0.22f, 0});
    return scene;
  }

  std::mt19937 random_;
  const Scene scene_ = make_scene();
};

TEST(HeldBodies, RandomDragsLeaveNothingBehind) {
  const char* const wanted = std::getenv("SOFTCELL_RANDOM_DRAGS");
  const int drags = wanted != nullptr ? std::atoi(wanted) : 30;
  ASSERT_GT(drags, 0) << "SOFTCELL_RANDOM_DRAGS=" << wanted;
  RandomDrags random(1);
  Simulation3d simulation(random.scene(), {.spes = 2});
  for (int drag = 0; drag < drags; ++drag) {
    random.drag(simulation);
    for (std::size_t b = 0; b < simulation.soft_bodies(); ++b) {
      const ppu::SoftBody<3>& body = simulation.soft_body(b);
      ASSERT_TRUE(body.bounds().low.allFinite() && body.bounds().high.allFinite())
          << "drag " << drag << ", body " << b;
      const float at_rest = (ppu::bounds(random.scene().soft_bodies[b].mesh).high -
                             ppu::bounds(random.scene().soft_bodies[b].mesh).low)
                                .norm();
      ASSERT_LT(size_of(body).norm(), 2 * at_rest)
          << "drag " << drag << ": a part of body " << b << " stays behind";
      ASSERT_GT(least_volume(body), -0.5f) << "drag " << drag << ", body " << b;
    }
  }
}

TEST(HeldBodies, TheSameDragsGiveTheSameBitsWithAnySpesAndFromARecording) {
  Recording<3> recording{.scene = "rigid", .frames = 0, .events = {}};
  std::uint64_t hash = 0;
  RandomDrags scene_only(1);
  for (const int spes : {1, 6}) {
    RandomDrags random(5);
    Simulation3d simulation(random.scene(), {.spes = spes});
    random.drag(simulation);
    if (hash == 0) hash = simulation.state_hash();
    EXPECT_EQ(simulation.state_hash(), hash) << spes << " SPEs";
  }
  // Again, event by event, through the text of a recording.
  Simulation3d simulation(scene_only.scene(), {.spes = 3});
  User user(simulation);
  const auto note = [&] {
    for (const InputEvent<3>& event : simulation.last_events())
      recording.events.push_back({recording.frames, event});
    ++recording.frames;
  };
  ASSERT_TRUE(take_from_above(user, simulation.soft_body(1)));
  note();
  user.move({3, 4, 5}, 20, note);
  user.release();
  note();
  hash = simulation.state_hash();
  const Recording<3> read = parse_recording<3>(to_text(recording));
  ASSERT_EQ(read, recording);
  Simulation3d again(scene_only.scene(), {.spes = 3});
  std::size_t next = 0;
  for (std::int64_t frame = 0; frame < read.frames; ++frame) {
    Events events;
    for (; next < read.events.size() && read.events[next].frame == frame; ++next)
      events.push_back(read.events[next].event);
    again.step(events);
  }
  EXPECT_EQ(again.state_hash(), hash);
}

}  // namespace
}  // namespace softcell::demos
