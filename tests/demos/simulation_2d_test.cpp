// The 2D demo's promises: the man comes back from whatever one does to him, and nothing leaves its framework.

#include "simulation/simulation_2d.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "random_play.h"
#include "replayed.h"
#include "scene_file/scene_library.h"
#include "simulation_runs.h"
#include "support/slow_build.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2f;
using Event = InputEvent<2>;

using test::kTenSeconds;
using test::outside;

Event hand(Action action, const Vector2f& at = {0, 0}) { return test::users_hand(action, at); }

/// Lets go of the man.
void expect_return_to_shape(Simulation2d& simulation, const Scene2d& scene) {
  simulation.step(
      std::vector<Event>{hand(Action::kRelease), {.action = Action::kGravity, .value = {0, -scene.gravity}}});
  step(simulation, kTenSeconds);
  // Without gravity nothing presses him, and he has his very shape again.
  simulation.step(std::vector<Event>{{.action = Action::kGravity}});
  step(simulation, 2 * kTenSeconds);
  EXPECT_LT(simulation.soft_body(0).deformation(), 0.5f * scene.soft_bodies[0].settings.cell_size);
}

class DraggedIntoACorner : public testing::TestWithParam<float> {};

TEST_P(DraggedIntoACorner, TheManReturnsToHisShape) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d simulation(scene);
  simulation.step(std::vector<Event>{{.action = Action::kGravity, .value = {0, -GetParam()}},
                                     hand(Action::kGrab, {0, 2}),
                                     hand(Action::kMoveHand, {6, -5})});
  float most = 0;
  for (int frame = 1; frame < kTenSeconds; ++frame) {
    // Back and forth behind the corner, as one who wants to get him through.
    const float shake = frame / 30 % 2 == 0 ? 1.0f : 0.0f;
    simulation.step(std::vector<Event>{hand(Action::kMoveHand, Vector2f(6 - 4 * shake, -5 + 2 * shake))});
    most = std::max(most, simulation.soft_body(0).deformation());
    ASSERT_LE(outside(simulation, scene), 0) << "frame " << frame;
  }
  EXPECT_GT(most, 0.5f) << "metres: he was dragged hard";
  expect_return_to_shape(simulation, scene);
}

/// As a user's hand holds him now: by a patch.
TEST_P(DraggedIntoACorner, TheManThatIsHeldByAPatchReturnsToHisShape) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d simulation(scene);
  simulation.step(std::vector<Event>{{.action = Action::kGravity, .value = {0, -GetParam()}},
                                     hand(Action::kHold, {0, 2}),
                                     hand(Action::kMoveHand, {6, -5})});
  for (int frame = 1; frame < kTenSeconds; ++frame) {
    const float shake = frame / 30 % 2 == 0 ? 1.0f : 0.0f;
    simulation.step(std::vector<Event>{hand(Action::kMoveHand, Vector2f(6 - 4 * shake, -5 + 2 * shake))});
    ASSERT_LE(outside(simulation, scene), 0) << "frame " << frame;
  }
  expect_return_to_shape(simulation, scene);
}

INSTANTIATE_TEST_SUITE_P(Gravity, DraggedIntoACorner, testing::Values(9.81f, -9.81f, 0.0f, 300.0f));

TEST(DraggedIntoACornerByARecordedHand, TheManReturnsToHisShape) {
  float most = 0;
  Replayed replayed("man_in_a_corner", [&](const Replayed& now) {
    most = std::max(most, now.simulation().soft_body(0).deformation());
    EXPECT_LE(outside(now.simulation(), now.scene()), 0);
  });
  EXPECT_GT(most, 0.5f) << "metres: he was dragged hard";
  expect_return_to_shape(replayed.simulation(), replayed.scene());
}

// A thousand of them, and in many ways: see ci/random-inputs.
TEST(Framework, KeepsEverythingInAtAnyInput) {
  const Scene2d scene = load_scene_2d("man");
  for (const float gravity : {9.81f, 300.0f}) {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      Simulation2d simulation(scene);
      test::RandomPlay input(seed, gravity);
      for (int frame = 0; frame < kTenSeconds; ++frame) {
        simulation.step(input.next_frame());
        ASSERT_LE(outside(simulation, scene), 0)
            << "gravity " << gravity << ", seed " << seed << ", frame " << frame;
      }
    }
  }
}

TEST(Framework, KeepsEverythingInAtAGravityOf300) {
  const Scene2d scene = load_scene_2d("man");
  for (const Vector2f& gravity :
       {Vector2f(0, -300), Vector2f(0, 300), Vector2f(300, 0), Vector2f(-300, 0), Vector2f(-212, -212)}) {
    Simulation2d simulation(scene);
    simulation.step(std::vector<Event>{{.action = Action::kGravity, .value = gravity}});
    for (int frame = 0; frame < kTenSeconds; ++frame) {
      simulation.step();
      ASSERT_LE(outside(simulation, scene), 0) << "frame " << frame << ", gravity " << gravity.transpose();
    }
  }
}

TEST(Simulation2d, TheSameEventsGiveTheSameState) {
  const Scene2d scene = load_scene_2d("man");
  const auto play = [&] {
    Simulation2d simulation(scene);
    simulation.step(std::vector<Event>{hand(Action::kGrab, {1, 1}), hand(Action::kMoveHand, {3, 2})});
    step(simulation, 100);
    simulation.step(std::vector<Event>{hand(Action::kRelease)});
    step(simulation, 100);
    return simulation.state_hash();
  };
  EXPECT_EQ(play(), play());
}

TEST(Simulation2d, TheNumberOfSpesAndTheOrderOfTransfersDoNotMatter) {
  const Scene2d scene = load_scene_2d("stack");
  const auto play = [&](const SimulationOptions& options) {
    Simulation2d simulation(scene, options);
    simulation.step(std::vector<Event>{hand(Action::kGrab, {0, 0}), hand(Action::kMoveHand, {3, 2})});
    step(simulation, 60);
    return simulation.state_hash();
  };
  const std::uint64_t with_six = play({});
  for (int spes = 1; spes < 6; ++spes) EXPECT_EQ(play({.spes = spes}), with_six) << spes << " SPEs";
  for (const char* const schedule : {"lazy", "random:1"})
    EXPECT_EQ(play({.schedule = dma::parse_schedule(schedule)}), with_six) << schedule;
}

TEST(Simulation2d, TheReferenceIsCloseToTheSpes) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d spes(scene), reference(scene, {.solver = Solver::kReference});
  step(spes, 30);
  step(reference, 30);
  EXPECT_NE(spes.state_hash(), reference.state_hash()) << "the SPU rounds towards zero";
  for (std::size_t i = 0; i < spes.particles(); ++i) {
    EXPECT_LT((spes.soft_body(0).positions()[i] - reference.soft_body(0).positions()[i]).norm(), 1e-4f);
  }
}

TEST(Simulation2d, AnInputIsSeenInTheVeryNextStep) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d quiet(scene), pushed(scene);
  quiet.step();
  pushed.step(std::vector<Event>{{.action = Action::kPush, .body = 0, .value = {1, 0}}});
  EXPECT_NE(quiet.state_hash(), pushed.state_hash());
}

TEST(Simulation2d, AHandCarriesTheManAndThrowsHim) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d simulation(scene);
  step(simulation, 120);
  simulation.step(std::vector<Event>{hand(Action::kGrab, {0, 0}), hand(Action::kMoveHand, {0, 2.4f})});
  step(simulation, 120);
  EXPECT_GT(simulation.soft_body(0).centre_of_mass().y(), -0.5f) << "he hangs in the air";
  ASSERT_EQ(simulation.held().size(), 1u);
  EXPECT_EQ(simulation.held()[0].target, Vector2f(0, 2.4f));
  for (int i = 0; i < 10; ++i)
    simulation.step(
        std::vector<Event>{hand(Action::kMoveHand, Vector2f(0.3f * static_cast<float>(i), 2.4f))});
  simulation.step(std::vector<Event>{hand(Action::kRelease)});
  EXPECT_TRUE(simulation.held().empty());
  EXPECT_GT(simulation.soft_body(0).linear_momentum().x(), 0);
}

TEST(Simulation2d, AHandLiftsARigidBodyAndThrowsIt) {
  const Scene2d scene = load_scene_2d("stack");
  Simulation2d simulation(scene);
  const auto is_box = [](const RigidBody2d& body) { return body.mass > 0; };
  const auto box =
      static_cast<std::size_t>(std::ranges::find_if(scene.rigid_bodies, is_box) - scene.rigid_bodies.begin());
  const auto position = [&] { return simulation.rigid_pose(box).position; };
  Vector2f at = position() + Vector2f(0.3f, 0.2f);
  auto take = simulation.touch(at);
  ASSERT_TRUE(take);
  EXPECT_EQ(take->action, Action::kHoldRigid);
  EXPECT_EQ(take->body, box);
  take->hand = kUsersHand;
  simulation.step(std::vector<Event>{*take});
  const auto move = [&](const Vector2f& velocity, int frames) {
    for (int frame = 0; frame < frames; ++frame) {
      at += velocity / 60;
      simulation.step(std::vector<Event>{hand(Action::kMoveHand, at)});
    }
  };
  move({0, 1.5f}, 30);
  move({0, 0}, 90);
  EXPECT_NEAR(position().x(), at.x(), 0.1f) << "it hangs from the hand, by a corner";
  EXPECT_NEAR(position().y(), at.y() - Vector2f(0.3f, 0.2f).norm(), 0.1f);
  Shown2d shown;
  simulation.show(shown);
  ASSERT_EQ(shown.hands.size(), 1u);
  EXPECT_LT((shown.hands[0][0] - at).norm(), 0.02f);
  move({-2, 0}, 20);
  simulation.step(std::vector<Event>{hand(Action::kRelease)});
  const Vector2f before = position();
  simulation.step();
  EXPECT_NEAR((position() - before).x() * 60, -2, 0.4f);
  const auto particle = simulation.touch(simulation.soft_body(0).position(0));
  ASSERT_TRUE(particle);
  EXPECT_EQ(particle->action, Action::kHold) << "where no rigid body is";
  EXPECT_EQ(particle->body, 0u);
}

/// Discs of 4 to 40 cells, 16 to 1,300 particles: a hand lifts, carries and throws each, and pulls no nipple out of it.
class HeldDisc : public testing::TestWithParam<int> {};

TEST_P(HeldDisc, IsLiftedCarriedAndThrown) {
  const Scene2d scene = std::get<Scene2d>(parse_scene(
      fmt::format(
          "dimension = 2\n[framework]\nwidth = 20\nheight = 12\n[[soft_body]]\ncell_size = {}\nalpha = 0.6\n"
          "shape = {{ kind = \"disc\", diameter = {} }}\nposition = [0, -4.9]\n",
          2.0 / GetParam(), GetParam()),
      "s.toml"));
  Simulation2d simulation(scene);
  step(simulation, 60);
  const ppu::SoftBody<2>& body = simulation.soft_body(0);
  const auto middle = [&] { return simulation.soft_body(0).centre_of_mass(); };
  const Vector2f lay = middle();
  Vector2f at = body.bounds().high;
  at.x() = lay.x();  // its top
  auto taken = simulation.touch(at);
  ASSERT_TRUE(taken);
  ASSERT_EQ(taken->action, Action::kHold);
  taken->hand = kUsersHand;
  simulation.step(std::vector<Event>{*taken});
  const auto move = [&](const Vector2f& velocity, int frames) {
    for (int frame = 0; frame < frames; ++frame) {
      at += velocity / 60;
      auto event = hand(Action::kMoveHand, at);
      event.hand = kUsersHand;
      simulation.step(std::vector<Event>{event});
    }
  };
  move({0, 2}, 60);
  EXPECT_GT(middle().y(), lay.y() + 1.5f) << "it is lifted";
  EXPECT_LT(body.deformation(), 0.35f) << "of a disc of 2 m";
  move({0, 0}, 90);
  EXPECT_LT((body.linear_momentum() / body.model().mass()).norm(), 0.3f) << "it hangs still";
  move({3, 0}, 30);
  auto release = hand(Action::kRelease);
  release.hand = kUsersHand;
  simulation.step(std::vector<Event>{release});
  EXPECT_NEAR((simulation.soft_body(0).linear_momentum() / body.model().mass()).x(), 3, 0.6f)
      << "the hand's speed";
}

INSTANTIATE_TEST_SUITE_P(Cells, HeldDisc, testing::Values(4, 8, 20, 40));

/// The user's hand in a simulation of two dimensions.
class User2d {
 public:
  /// Takes what is at a point.
  User2d(Simulation2d& simulation, const Vector2f& at) : simulation_(simulation), at_(at) {
    auto taken = simulation.touch(at);
    if (!taken) throw std::runtime_error("nothing to take");
    taken->hand = kUsersHand;
    simulation.step(std::vector<Event>{*taken});
  }
  const Vector2f& at() const { return at_; }
  template <class AfterFrame>
  void move(const Vector2f& velocity, int frames, const AfterFrame& after_frame) {
    for (int frame = 0; frame < frames; ++frame) {
      at_ += velocity / 60;
      simulation_.step(std::vector<Event>{hand(Action::kMoveHand, at_)});
      after_frame();
    }
  }
  void move(const Vector2f& velocity, int frames) {
    move(velocity, frames, [] {});
  }

 private:
  Simulation2d& simulation_;
  Vector2f at_;
};

class HandsAndContacts : public testing::TestWithParam<ppu::ContactMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, HandsAndContacts,
                         testing::Values(ppu::ContactMethod::kSpheres, ppu::ContactMethod::kSurface));

/// As in three dimensions, in held_bodies_test.cpp: a ring that is held, and a disc that lies in it.
TEST_P(HandsAndContacts, AHandCarriesWhatStandsOnTheBodyThatItHolds) {
  const Scene2d scene = std::get<Scene2d>(
      parse_scene("dimension = 2\n[framework]\nwidth = 8\nheight = 6\n"
                  "[[soft_body]]\ncell_size = 0.15\nalpha = 0.8\ndamping = 0.2\nhalf_width = 3\n"
                  "shape = { kind = \"ring\", diameter = 16, hole = 10 }\nposition = [0, -1.72]\n"
                  "[[soft_body]]\ncell_size = 0.1\nalpha = 0.8\ndamping = 0.2\n"
                  "shape = { kind = \"disc\", diameter = 5 }\nposition = [0, -2.05]\n",
                  "s.toml"));
  Simulation2d simulation(scene, {.contacts = GetParam()});
  step(simulation, 30);
  const ppu::SoftBody<2>&ring = simulation.soft_body(0), &disc = simulation.soft_body(1);
  const Vector2f before = disc.centre_of_mass();
  User2d user(simulation, {ring.centre_of_mass().x(), ring.bounds().high.y() - 0.02f});
  user.move({0, 2}, 30);
  user.move({0, 0}, 240);
  EXPECT_GT(disc.centre_of_mass().y(), before.y() + 0.6f) << "it is lifted, by what the ring does not give";
  const auto speed = [](const ppu::SoftBody<2>& body) {
    return (body.linear_momentum() / body.model().mass()).norm();
  };
  EXPECT_LT(speed(ring) + speed(disc), 0.1f) << "both hang still";
  EXPECT_LT((disc.centre_of_mass() - ring.centre_of_mass()).norm(), 0.7f) << "it lies in the ring";
  Shown2d shown;
  simulation.show(shown);
  ASSERT_EQ(shown.hands.size(), 1u);
  EXPECT_LT((shown.hands[0][0] - user.at()).norm(), 0.05f);
}

/// How deep what is drawn of the man is in a wall, cells.
float depth_in_walls(const ppu::SoftBody<2>& man, const ppu::Skin2d& skin) {
  std::vector<Vector2f> places(skin.rest.size()), slopes(skin.rest.size());
  ppu::deform(skin, man.positions(), places, slopes);
  float deepest = 0;
  for (const Vector2f& place : places)
    deepest = std::max(deepest, (place.cwiseAbs() - Vector2f(4, 3)).maxCoeff());
  return deepest / man.settings().cell_size;
}

/// A hand that pulls him through a wall or a corner, with all its strength.
TEST_P(HandsAndContacts, AHandPressesNobodyIntoAWall) {
  const Scene2d scene = load_scene_2d("man");
  constexpr int kWays = kSlowBuild ? 4 : 16;
  std::vector<float> depths;
  for (int i = 0; i < kWays; ++i) {
    const Vector2f way =
        Eigen::Rotation2Df(2 * std::numbers::pi_v<float> * static_cast<float>(i) / kWays) * Vector2f(10, 0);
    Simulation2d simulation(scene, {.contacts = GetParam()});
    const ppu::SoftBody<2>& man = simulation.soft_body(0);
    const ppu::Skin2d skin = scene.soft_bodies[0].skin(man.model().lattice());
    User2d user(simulation, man.centre_of_mass());
    float deepest = 0, outside = -1;
    const auto look = [&] {
      deepest = std::max(deepest, depth_in_walls(man, skin));
      outside = std::max(outside, test::outside(simulation, scene));
    };
    user.move(way, 60, look);
    user.move({0, 0}, 120, look);
    depths.push_back(deepest);
    EXPECT_LT(outside, 0.05f * man.settings().cell_size) << way.transpose();
  }
  std::ranges::sort(depths);
  if (GetParam() == ppu::ContactMethod::kSpheres) {
    EXPECT_LT(depths.back(), 0.35f);
  } else {
    // Of a limb that is bent double the drawn edge, half a cell wide, may be in the wall, and no particle.
    EXPECT_LT(depths[kWays / 2], 0.6f);
    EXPECT_LT(depths[kWays * 3 / 4], 0.75f);
    EXPECT_LT(depths.back(), 1.25f);
  }
}

TEST(Simulation2d, AStackSleepsAndWakesWhenGravityChangesOrAHandTakesIt) {
  Scene2d scene = load_scene_2d("stack");
  scene.sleep = true;
  const std::uint64_t one_that_never_sleeps = scene_hash(load_scene_2d("stack"));
  EXPECT_NE(scene_hash(scene), one_that_never_sleeps);
  // What is drawn of the rings is round, so that they roll from under their load in the end. Circles hold each other like cogs.
  Simulation2d simulation(scene, {.contacts = ppu::ContactMethod::kSpheres});
  const auto all_sleep = [&] {
    for (std::size_t b = 0; b < simulation.soft_bodies(); ++b)
      if (!simulation.soft_body(b).asleep()) return false;
    return true;
  };
  int frame = 0;
  for (; frame < 2 * kTenSeconds && !all_sleep(); ++frame) simulation.step();
  EXPECT_TRUE(all_sleep());
  const std::uint64_t asleep = simulation.state_hash();
  step(simulation, 30);
  EXPECT_EQ(simulation.state_hash(), asleep);

  // What falls to the other side now has slept on the lower one.
  simulation.step(std::vector<Event>{{.action = Action::kGravity, .value = {0, scene.gravity}}});
  step(simulation, kTenSeconds);
  for (std::size_t b = 0; b < simulation.soft_bodies(); ++b)
    EXPECT_GT(simulation.soft_body(b).centre_of_mass().y(), 0) << b;
  for (; !all_sleep() && frame < 8 * kTenSeconds; ++frame) simulation.step();
  EXPECT_TRUE(all_sleep());

  const Vector2f there = simulation.soft_body(0).centre_of_mass();
  simulation.step(
      std::vector<Event>{hand(Action::kGrab, there), hand(Action::kMoveHand, there - Vector2f(0, 1))});
  step(simulation, 5);
  EXPECT_FALSE(simulation.soft_body(0).asleep());
}

TEST(Simulation2d, KnowsWhereThereIsRoom) {
  const Scene2d scene = load_scene_2d("man");  // a room of 8 by 6 m, in its middle the man
  const Simulation2d simulation(scene);
  EXPECT_TRUE(simulation.is_free({-3, 2}, 1));
  EXPECT_FALSE(simulation.is_free({-3.8f, 2}, 1)) << "in the wall";
  EXPECT_FALSE(simulation.is_free(simulation.soft_body(0).centre_of_mass(), 1)) << "in the man";
  EXPECT_TRUE(simulation.is_free({-100, 2}, 1)) << "outside";
}

TEST(Simulation2d, APauseHoldsAndASingleStepIsOneFrame) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d simulation(scene), free(scene);
  free.step();
  const std::uint64_t after_one = free.state_hash();
  simulation.step(std::vector<Event>{{.action = Action::kPause}});
  const std::uint64_t paused = simulation.state_hash();
  EXPECT_TRUE(simulation.paused());
  step(simulation, 10);
  EXPECT_EQ(simulation.state_hash(), paused);
  simulation.step(std::vector<Event>{{.action = Action::kSingleStep}});
  EXPECT_EQ(simulation.state_hash(), after_one);
  step(simulation, 10);
  EXPECT_EQ(simulation.state_hash(), after_one);
}

TEST(Simulation2d, AResetIsTheBeginningInAllBits) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d fresh(scene), used(scene);
  used.step(std::vector<Event>{hand(Action::kGrab, {1, 1}),
                               hand(Action::kMoveHand, {3, 2}),
                               {.action = Action::kGravity, .value = {50, 0}}});
  step(used, 200);
  used.step(std::vector<Event>{{.action = Action::kReset}});
  fresh.step();
  step(used, 200);
  step(fresh, 200);
  EXPECT_EQ(used.state_hash(), fresh.state_hash());
}

// Box2D ends the process at a shape without area or inertia.
TEST(Simulation2d, RigidBodiesOfAnySizeAndPlaceMove) {
  std::string text = "dimension = 2\n";
  const auto add = [&](const std::string& kind, const std::string& shape) {
    for (const char* const mass : {"0.000001", "1", "1000000"}) {
      text += "[[" + kind + "]]\n" + shape + "\nmass = " + mass + "\n";
      text += "[[" + kind + "]]\n" + shape + "\nangle = 2\nposition = [-9000, 9000]\nmass = " + mass + "\n";
    }
  };
  add("polygon", "corners = [[100, 1], [100.1, 1], [100.1, 1.1], [100, 1.1]]");
  add("polygon", "corners = [[9999, 1], [9999.02, 1], [9999.02, 1.02]]");
  add("polygon", "corners = [[-10000, -10000], [10000, -10000], [10000, 10000], [-10000, 10000]]");
  add("polygon", "corners = [[0, 0], [7000, 6950], [7050, 7050], [6950, 7000]]");
  add("box", "size = [0.01, 10000]");
  add("box", "size = [0.01, 0.01]");
  add("circle", "radius = 0.01");
  add("circle", "radius = 10000");
  const Scene2d scene = std::get<Scene2d>(parse_scene(text, "s.toml"));
  Simulation2d simulation(scene, {.solver = Solver::kReference});
  step(simulation, 3);
  for (std::size_t i = 0; i < scene.rigid_bodies.size(); ++i)
    EXPECT_TRUE(simulation.rigid_pose(i).position.allFinite()) << i;
}

class FrameTimesOf2d : public testing::TestWithParam<Solver> {};

TEST_P(FrameTimesOf2d, ContactsOfSurfacesAreNotCountedAsShapeMatching) {
  const Scene2d scene = load_scene_2d("stack");
  FrameTimes surface, spheres;
  const auto add = [](FrameTimes& sum, const FrameTimes& one) {
    EXPECT_DOUBLE_EQ(one.ppu_ms, one.gather_ms + one.solve_ms + one.apply_ms + one.contacts_ms + one.skin_ms);
    EXPECT_GT(one.solve_ms, 0);
    sum.solve_ms += one.solve_ms, sum.contacts_ms += one.contacts_ms, sum.apply_ms += one.apply_ms;
  };
  Simulation2d touching(scene, {.solver = GetParam(), .spes = 2});
  Simulation2d with_circles(scene,
                            {.solver = GetParam(), .contacts = ppu::ContactMethod::kSpheres, .spes = 2});
  for (int frame = 0; frame < 60; ++frame) {
    add(surface, touching.step());
    add(spheres, with_circles.step());
  }
  EXPECT_GT(surface.contacts_ms, 0);
  EXPECT_LT(surface.apply_ms, surface.contacts_ms) << "next to nothing is copied to Box2D";
  EXPECT_EQ(spheres.contacts_ms, 0) << "Box2D's";
  EXPECT_GT(spheres.apply_ms, 0);
}

INSTANTIATE_TEST_SUITE_P(Solvers, FrameTimesOf2d, testing::Values(Solver::kSpe, Solver::kReference),
                         [](const auto& tested) {
                           return tested.param == Solver::kSpe ? "OnSpes" : "OnThePpu";
                         });

TEST(Simulation2d, TheLightestAndSmallestMaterialMoves) {
  const Scene2d scene = std::get<Scene2d>(
      parse_scene("dimension = 2\n[[soft_body]]\ncell_size = 0.001\ndensity = 0.001\ncontact_radius = 0.01\n"
                  "shape = { kind = \"disc\" }\n[[box]]\nsize = [0.1, 0.01]\nposition = [0, -0.02]\n",
                  "s.toml"));
  Simulation2d simulation(scene);
  step(simulation, 60);
  EXPECT_GT(simulation.soft_body(0).centre_of_mass().y(), -0.015f) << "it lies on the box";
  EXPECT_LT(simulation.soft_body(0).centre_of_mass().y(), -0.005f) << "it has fallen";
}

TEST(Simulation2d, HandsOfNothingAndBodiesThatAreNotThereDoNothing) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d quiet(scene), told(scene);
  quiet.step();
  told.step(std::vector<Event>{hand(Action::kMoveHand, {1, 1}),
                               hand(Action::kRelease),
                               {.action = Action::kGrab, .body = 7},
                               {.action = Action::kPush, .body = 7, .value = {1, 1}}});
  EXPECT_EQ(quiet.state_hash(), told.state_hash());
  EXPECT_TRUE(told.held().empty());
}

}  // namespace
}  // namespace softcell::demos
