// The 2D demo's promises: the man comes back from whatever one does to him, and nothing leaves its framework.

#include "simulation_2d.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "scene_file/scene_library.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2f;
using Event = InputEvent<2>;

constexpr int kTenSeconds = 600;  // frames

Event hand(Action action, const Vector2f& at = {0, 0}) {
  return {.action = action, .hand = kUsersHand, .body = kEveryBody, .value = at};
}

/// Of the scene `man`: its framework's inner sides.
const Vector2f kRoom{4, 3};

/// The farthest that any particle or rigid body's centre is outside of the room, in metres; below 0: inside.
float outside(const Simulation2d& simulation, const Scene2d& scene) {
  float farthest = -kRoom.minCoeff();
  const auto look = [&](const Vector2f& p) {
    farthest = std::max(farthest, (p.cwiseAbs() - kRoom).maxCoeff());
  };
  for (std::size_t b = 0; b < simulation.soft_bodies(); ++b) {
    for (const Vector2f& p : simulation.soft_body(b).positions()) look(p);
  }
  for (std::size_t b = 0; b < scene.rigid_bodies.size(); ++b) {
    if (scene.rigid_bodies[b].mass > 0) look(simulation.rigid_pose(b).position);
  }
  return farthest;
}

void run(Simulation2d& simulation, int frames) {
  for (int i = 0; i < frames; ++i) simulation.step();
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
  simulation.step(
      std::vector<Event>{hand(Action::kRelease), {.action = Action::kGravity, .value = {0, -scene.gravity}}});
  run(simulation, kTenSeconds);
  // Without gravity nothing presses him, and he has his very shape again.
  simulation.step(std::vector<Event>{{.action = Action::kGravity}});
  run(simulation, 2 * kTenSeconds);
  EXPECT_LT(simulation.soft_body(0).deformation(), 0.5f * scene.soft_bodies[0].settings.cell_size);
}

INSTANTIATE_TEST_SUITE_P(Gravity, DraggedIntoACorner, testing::Values(9.81f, -9.81f, 0.0f, 300.0f));

/// Ten seconds of somebody who does not spare the man.
void play_at_random(std::uint32_t seed) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d simulation(scene);
  std::mt19937 random(seed);
  const auto up_to = [&](float limit) {  // the same numbers with every library
    return limit * (static_cast<float>(random() >> 8) / float{1 << 23} - 1);
  };
  const auto point = [&] {
    const float x = up_to(8), y = up_to(6);  // the hand goes outside, too
    return Vector2f(x, y);
  };
  for (int frame = 0; frame < kTenSeconds; ++frame) {
    std::vector<Event> events;
    switch (random() % 32) {
      case 0:
        events.push_back(hand(Action::kGrab, point()));
        break;
      case 1:
        events.push_back(hand(Action::kRelease));
        break;
      case 2: {
        const float x = up_to(300), y = up_to(300);
        events.push_back({.action = Action::kGravity, .value = {x, y}});
        break;
      }
      case 3: {
        const float x = up_to(50), y = up_to(50);
        events.push_back({.action = Action::kPush, .body = kEveryBody, .value = {x, y}});
        break;
      }
      case 4:
        if (random() % 8 == 0) events.push_back({.action = Action::kReset});
        break;
      default:
        if (random() % 4 == 0) events.push_back(hand(Action::kMoveHand, point()));
    }
    simulation.step(events);
    ASSERT_LE(outside(simulation, scene), 0) << "seed " << seed << ", frame " << frame;
  }
}

TEST(Framework, KeepsEverythingInAtAnyInput) {
  // All of them: see docs/soft-bodies.md.
  const char* const wanted = std::getenv("SOFTCELL_RANDOM_INPUTS");
  const int inputs = wanted != nullptr ? std::atoi(wanted) : 10;
  for (int seed = 1; seed <= inputs && !HasFatalFailure(); ++seed)
    play_at_random(static_cast<std::uint32_t>(seed));
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
    run(simulation, 100);
    simulation.step(std::vector<Event>{hand(Action::kRelease)});
    run(simulation, 100);
    return simulation.state_hash();
  };
  EXPECT_EQ(play(), play());
}

TEST(Simulation2d, TheNumberOfSpesAndTheOrderOfTransfersDoNotMatter) {
  const Scene2d scene = load_scene_2d("stack");
  const auto play = [&](const SimulationOptions& options) {
    Simulation2d simulation(scene, options);
    simulation.step(std::vector<Event>{hand(Action::kGrab, {0, 0}), hand(Action::kMoveHand, {3, 2})});
    run(simulation, 60);
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
  run(spes, 30);
  run(reference, 30);
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
  run(simulation, 120);
  simulation.step(std::vector<Event>{hand(Action::kGrab, {0, 0}), hand(Action::kMoveHand, {0, 2.4f})});
  run(simulation, 120);
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

TEST(Simulation2d, APauseHoldsAndASingleStepIsOneFrame) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d simulation(scene), free(scene);
  free.step();
  const std::uint64_t after_one = free.state_hash();
  simulation.step(std::vector<Event>{{.action = Action::kPause}});
  const std::uint64_t paused = simulation.state_hash();
  EXPECT_TRUE(simulation.paused());
  run(simulation, 10);
  EXPECT_EQ(simulation.state_hash(), paused);
  simulation.step(std::vector<Event>{{.action = Action::kSingleStep}});
  EXPECT_EQ(simulation.state_hash(), after_one);
  run(simulation, 10);
  EXPECT_EQ(simulation.state_hash(), after_one);
}

TEST(Simulation2d, AResetIsTheBeginningInAllBits) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d fresh(scene), used(scene);
  used.step(std::vector<Event>{hand(Action::kGrab, {1, 1}),
                               hand(Action::kMoveHand, {3, 2}),
                               {.action = Action::kGravity, .value = {50, 0}}});
  run(used, 200);
  used.step(std::vector<Event>{{.action = Action::kReset}});
  fresh.step();
  run(used, 200);
  run(fresh, 200);
  EXPECT_EQ(used.state_hash(), fresh.state_hash());
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
