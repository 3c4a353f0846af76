// What a scene's script does to a simulation.

#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "input/script_player.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_2d.h"
#include "simulation/simulation_3d.h"
#include "simulation_runs.h"

namespace softcell::demos {

/// In the names of tests.
void PrintTo(Skin skin, std::ostream* out) { *out << (skin == Skin::kSpe ? "spe" : "gpu"); }

namespace {

Scene floating_cube(const std::string& script) {
  return std::get<Scene>(
      parse_scene("world = { gravity = 0 }\n"
                  "[[soft_body]]\nname = \"cube\"\ncell_size = 0.25\n"
                  "shape = { kind = \"box\", size = [0.5, 0.5, 0.5] }\n" +
                      script,
                  "s.toml"));
}

TEST(Script, AnImpulseIsGivenOnceAndAtItsTime) {
  const Scene scene = floating_cube("[[impulse]]\ntime = 0.5\nbody = \"cube\"\nvelocity = [1, 2, 3]\n");
  Simulation3d simulation(scene, {});
  step(simulation, 30);
  const float mass = simulation.model(0).mass();
  EXPECT_LT((simulation.soft_body(0).linear_momentum() / mass).norm(), 2e-7f);  // m/s: units of MatchHold
  step(simulation, 30);
  EXPECT_LT((simulation.soft_body(0).linear_momentum() / mass - Eigen::Vector3f(1, 2, 3)).norm(), 0.01f);
}

TEST(Script, GravityChangesAtItsTime) {
  const Scene scene =
      floating_cube("[[gravity]]\ntime = 0\nvalue = -6\n[[gravity]]\ntime = 0.5\nvalue = 0\n");
  Simulation3d simulation(scene, {});
  step(simulation, 60);
  const Eigen::Vector3f velocity = simulation.soft_body(0).linear_momentum() / simulation.model(0).mass();
  EXPECT_NEAR(velocity.y(), 3, 0.05f) << "half a second upwards";
}

TEST(Script, AHandTakesABodyAlongAndLetsGo) {
  const Scene scene = floating_cube(
      "[[drag]]\nbody = \"cube\"\nbegin = 0\nend = 2\n"
      "from = [0.25, 0, 0]\nto = [3.25, 0, 0]\n");
  Simulation3d simulation(scene, {});
  step(simulation, 120);
  EXPECT_NEAR(simulation.soft_body(0).centre_of_mass().x(), 3, 0.5f);
  const Eigen::Vector3f before = simulation.soft_body(0).linear_momentum();
  step(simulation, 30);
  EXPECT_LT((simulation.soft_body(0).linear_momentum() - before).norm(), 0.01f * before.norm());
}

TEST(Script, WorksInTwoDimensions) {
  const Scene2d scene =
      std::get<Scene2d>(parse_scene("dimension = 2\nworld = { gravity = 0 }\n"
                                    "[[soft_body]]\nname = \"b\"\ncell_size = 1\nrows = [\"##\"]\n"
                                    "[[impulse]]\ntime = 0\nbody = \"b\"\nvelocity = [1, 2]\n"
                                    "[[pause]]\nbegin = 1\nend = 2\n[[reset]]\ntime = 3\n",
                                    "s.toml"));
  // The reference solver leaves a body at rest exactly as it is; truncation on the SPEs does not.
  Simulation2d simulation(scene, {.solver = Solver::kReference});
  const std::uint64_t at_the_beginning = simulation.state_hash();
  int frame = 0;
  const auto run_until = [&](int end) {
    for (; frame < end; ++frame) simulation.step();
    return simulation.soft_body(0).centre_of_mass();
  };
  const Eigen::Vector2f after_one = run_until(60), after_two = run_until(120), after_three = run_until(180);
  EXPECT_LT((after_one - Eigen::Vector2f(1, 2)).norm(), 0.001f);
  EXPECT_EQ(after_two, after_one) << "the pause";
  EXPECT_LT((after_three - Eigen::Vector2f(2, 4)).norm(), 0.002f);
  run_until(181);
  EXPECT_EQ(simulation.state_hash(), at_the_beginning) << "there is no gravity, and the impulse is over";
}

/// The first and the last frame of each stretch at which time stands still.
std::vector<std::pair<int, int>> stillness(const std::vector<ScriptedPause>& pauses, int frames) {
  ScriptedInput<2> script;
  script.pauses = pauses;
  ScriptPlayer<2> player(script);
  std::vector<std::pair<int, int>> stretches;
  bool paused = false;
  for (int frame = 0; frame < frames; ++frame) {
    const bool before = paused;
    for (const InputEvent<2>& event : player.events_at(frame)) paused = event.action == Action::kPause;
    if (paused && !before) stretches.emplace_back(frame, frame);
    if (paused) stretches.back().second = frame;
  }
  return stretches;
}

TEST(Script, PausesThatTouchOrOverlapEndWithTheLast) {
  using Stretches = std::vector<std::pair<int, int>>;
  EXPECT_EQ(stillness({{1, 2}, {2, 3}}, 300), (Stretches{{60, 179}}));
  EXPECT_EQ(stillness({{2, 3}, {1, 2}}, 300), (Stretches{{60, 179}}));
  EXPECT_EQ(stillness({{1, 3}, {2, 4}}, 300), (Stretches{{60, 239}}));
  EXPECT_EQ(stillness({{2, 3}, {1, 4}}, 300), (Stretches{{60, 239}}));
  EXPECT_EQ(stillness({{1, 2}, {3, 4}}, 300), (Stretches{{60, 119}, {180, 239}}));
  EXPECT_EQ(stillness({{1, 1.001f}, {2, 3}}, 300), (Stretches{{120, 179}})) << "shorter than a frame";
}

TEST(Script, AResetIn3dBeginsAnew) {
  const char* const kFalling =
      "[framework]\n[[box]]\nsize = [0.3, 0.3, 0.3]\nmass = 5\nposition = [0.4, 0.6, 0]\n"
      "[[soft_body]]\nname = \"cube\"\ncell_size = 0.25\nposition = [0, 1.2, 0]\n"
      "shape = { kind = \"box\", size = [0.5, 0.5, 0.5] }\n";
  const auto scene_with = [&](const std::string& script) {
    return std::get<Scene>(parse_scene(kFalling + script, "s.toml"));
  };
  const Scene once = scene_with("");
  const Scene again = scene_with("[[reset]]\ntime = 1\n[[pause]]\nbegin = 1\nend = 1.5\n");
  Simulation3d first(once, {}), second(again, {});
  const std::uint64_t at_the_beginning = first.state_hash();
  step(first, 20);
  step(second, 60);
  EXPECT_NE(second.state_hash(), at_the_beginning);
  step(second, 1);
  EXPECT_EQ(second.state_hash(), at_the_beginning);
  step(second, 29 + 20);
  first.finish();
  second.finish();
  EXPECT_EQ(first.state_hash(), second.state_hash()) << "before anything touches anything";
  EXPECT_EQ(first.shown_box_poses().back(), second.shown_box_poses().back());
  step(first, 20);
  step(second, 20);
  const Eigen::Vector3f difference =
      first.soft_body(0).centre_of_mass() - second.soft_body(0).centre_of_mass();
  EXPECT_LT(difference.norm(), 0.05f) << "Bullet does not sort contacts; they are in another order";
}

/// Positions of a body's particles: those that are shown, or those that there are.
std::vector<Eigen::Vector4f> points(std::span<const Eigen::Vector4f> positions) {
  return {positions.begin(), positions.end()};
}

class ShownDuringAPause : public testing::TestWithParam<Skin> {};

TEST_P(ShownDuringAPause, IsWhatHomeAndResetPutElsewhere) {
  const Scene scene = std::get<Scene>(
      parse_scene("[framework]\n[tilt]\namplitude_x = 0.5\n[[box]]\nsize = [0.3, 0.3, 0.3]\nmass = 5\n"
                  "position = [1, 2, 0]\n[[soft_body]]\ncell_size = 0.25\nposition = [0, 3, 0]\n"
                  "shape = { kind = \"box\", size = [0.5, 0.5, 0.5] }\n",
                  "s.toml"));
  Simulation3d simulation(scene, {.skin = GetParam()});
  const auto at_the_beginning = points(simulation.shown_particles(0));
  const Eigen::Vector3f origin = simulation.shown(0).origin;
  const Eigen::Matrix4f box = simulation.shown_box_poses().back();
  const auto expect_the_beginning = [&](const char* after) {
    EXPECT_EQ(points(simulation.shown_particles(0)), at_the_beginning) << after;
    EXPECT_EQ(points(simulation.soft_body(0).padded_positions()), at_the_beginning) << after;
    EXPECT_EQ(simulation.shown(0).origin, origin) << after;
  };
  using Events = std::vector<InputEvent<3>>;
  step(simulation, 30);
  simulation.step(Events{{.action = Action::kPause}});
  EXPECT_NE(points(simulation.shown_particles(0)), at_the_beginning);
  simulation.step(Events{{.action = Action::kHome, .body = kEveryBody}});
  expect_the_beginning("home");
  EXPECT_NE(simulation.shown_box_poses().back(), box) << "the box falls on from where it is";
  simulation.step(Events{{.action = Action::kResume}});
  step(simulation, 30);
  simulation.step(Events{{.action = Action::kReset}, {.action = Action::kPause}});
  expect_the_beginning("reset");
  EXPECT_EQ(simulation.shown_box_poses().back(), box);
  EXPECT_EQ(simulation.shown_tilt(), Eigen::Matrix3f::Identity());
  step(simulation, 1);
  expect_the_beginning("a frame later");
  simulation.step(Events{{.action = Action::kResume}});
  simulation.finish();
  EXPECT_NE(points(simulation.shown_particles(0)), at_the_beginning);
}

INSTANTIATE_TEST_SUITE_P(Skins, ShownDuringAPause, testing::Values(Skin::kSpe, Skin::kGpu));

}  // namespace
}  // namespace softcell::demos
