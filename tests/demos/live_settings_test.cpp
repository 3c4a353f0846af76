// What the user changes of a run while it goes on: materials, substeps, slow motion.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "input/recording.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_2d.h"
#include "simulation/simulation_3d.h"
#include "simulation_runs.h"
#include "support/slow_build.h"

namespace softcell::demos {
namespace {

template <class Simulation, class Event>
void step_with(Simulation& simulation, const Event& event) {
  simulation.step({&event, 1});
}

struct Change {
  Action action;
  float value;
};
std::vector<Change> changes() {
  return {{Action::kAlpha, 0.9f},    {Action::kFrequency, 3},   {Action::kModulus, 900},
          {Action::kDamping, 0.6f},  {Action::kFriction, 0.1f}, {Action::kSubsteps, 5},
          {Action::kTimeScale, 0.5f}};
}

/// After so many frames, which bring the bodies to the floor: friction counts then.
constexpr int kToTheFloor = 120;

template <int Dimension, class Simulation, class Scene>
void expect_in_the_next_step(const Scene& scene) {
  for (const auto& [action, value] : changes()) {
    Simulation changed(scene, {.spes = 2}), unchanged(scene, {.spes = 2});
    step(changed, kToTheFloor), step(unchanged, kToTheFloor);
    InputEvent<Dimension> slide;
    slide.action = Action::kPush;
    slide.body = kEveryBody;
    slide.value[0] = 2;
    step_with(changed, slide), step_with(unchanged, slide);
    ASSERT_EQ(changed.state_hash(), unchanged.state_hash());
    step_with(changed, change<Dimension>(action, value));
    unchanged.step();
    EXPECT_NE(changed.state_hash(), unchanged.state_hash()) << "action " << static_cast<int>(action);
  }
}

TEST(LiveSettings, AChangeIsInTheStateWithTheNextStep) {
  expect_in_the_next_step<3, Simulation3d>(load_scene_3d("drop"));
}

TEST(LiveSettings, AChangeIsInTheStateWithTheNextStepIn2d) {
  expect_in_the_next_step<2, Simulation2d>(load_scene_2d("stack"));
}

TEST(LiveSettings, SetWhatTheySay) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d simulation(scene, {.spes = 1});
  const auto settings = [&] { return simulation.soft_body(0).settings(); };
  step_with(simulation, change<3>(Action::kFrequency, 7));
  EXPECT_EQ(settings().frequency, 7);
  step_with(simulation, change<3>(Action::kAlpha, 0.25f));
  EXPECT_EQ(settings().alpha, 0.25f);
  EXPECT_FALSE(settings().frequency) << "what was stated last counts";
  step_with(simulation, change<3>(Action::kModulus, 300));
  EXPECT_NEAR(settings().alpha, scene.soft_bodies[0].settings.alpha, 1e-6f) << "as the scene has it";
  step_with(simulation, change<3>(Action::kModulus, 1e9f));
  EXPECT_EQ(settings().alpha, 1) << "no stiffer than it can be";
  step_with(simulation, change<3>(Action::kFriction, 2));
  step_with(simulation, change<3>(Action::kDamping, 0.5f));
  EXPECT_EQ(settings().friction, 2);
  EXPECT_EQ(settings().damping, 0.5f);
  step_with(simulation, change<3>(Action::kSubsteps, 4));
  EXPECT_EQ(simulation.substeps(), 4);
  step_with(simulation, change<3>(Action::kTimeScale, 0.5f));
  EXPECT_EQ(simulation.time_scale(), 0.5f);
  step_with(simulation, change<3>(Action::kReset, 0));
  EXPECT_EQ(settings(), scene.soft_bodies[0].settings);
  EXPECT_EQ(simulation.substeps(), scene.substeps);
  EXPECT_EQ(simulation.time_scale(), 1);
}

TEST(LiveSettings, AResetIsTheBeginningInAllBits) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d simulation(scene, {.spes = 2});
  step(simulation, 30);
  const std::uint64_t hash = simulation.state_hash();
  for (const auto& [action, value] : changes()) step_with(simulation, change<3>(action, value));
  step(simulation, 7);
  step_with(simulation, change<3>(Action::kReset, 0));  // and the first frame
  step(simulation, 29);
  EXPECT_EQ(simulation.state_hash(), hash);
}

/// How much longer along x the rest shape of a body is after two hands have pulled it apart for a second, metres.
float longer_after_a_pull(float yield) {
  Scene scene = load_scene_3d("drop");
  scene.gravity = 0;
  Simulation3d simulation(scene, {.spes = 2});
  step_with(simulation, change<3>(Action::kYield, yield));
  step_with(simulation, change<3>(Action::kCreep, 40));
  std::vector<InputEvent<3>> hands;
  const ppu::SoftBody<3>& body = simulation.soft_body(0);
  const ppu::Bounds<3> box = body.bounds();
  const Eigen::Vector3f middle = 0.5f * (box.low + box.high), half = 0.5f * (box.high - box.low);
  for (std::uint32_t hand = 0; hand < 2; ++hand) {
    const Eigen::Vector3f side = (hand == 0 ? 1.0f : -1.0f) * half.x() * Eigen::Vector3f::UnitX();
    hands.push_back({.action = Action::kHold, .hand = hand, .body = 0, .value = middle + side});
    hands.push_back({.action = Action::kMoveHand, .hand = hand, .body = 0, .value = middle + 2 * side});
  }
  simulation.step(hands);
  step(simulation, 60);
  if (!body.has_own_rest()) return 0;
  const std::vector<Eigen::Vector3f> rest = body.rest_positions();
  const auto [low, high] = std::ranges::minmax(rest, {}, [](const Eigen::Vector3f& x) { return x.x(); });
  return high.x() - low.x() - 2 * half.x();
}

TEST(LiveSettings, APlasticBodyKeepsWhatAnElasticOneDoesNot) {
  EXPECT_GT(longer_after_a_pull(0.05f), 0.1f);
  EXPECT_EQ(longer_after_a_pull(0), 0);
}

TEST(LiveSettings, YieldAndCreepSetWhatTheySay) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d run(scene, {.spes = 1});
  const auto plasticity = [&] { return run.soft_body(0).settings().plasticity; };
  step_with(run, change<3>(Action::kCreep, 30));
  EXPECT_FALSE(plasticity()) << "creep alone makes nothing plastic";
  step_with(run, change<3>(Action::kYield, 0.2f));
  EXPECT_EQ(plasticity(), (ppu::Plasticity{.yield = 0.2f}));
  step_with(run, change<3>(Action::kCreep, 30));
  EXPECT_EQ(plasticity(), (ppu::Plasticity{.yield = 0.2f, .creep = 30}));
  step_with(run, change<3>(Action::kYield, 0));
  EXPECT_FALSE(plasticity());
  step_with(run, change<3>(Action::kYield, 1));
  step_with(run, change<3>(Action::kReset, 0));
  EXPECT_FALSE(plasticity()) << "as the scene has it";
}

TEST(LiveSettings, YieldAndCreepSetWhatTheySayIn2d) {
  const Scene2d scene = load_scene_2d("stack");
  Simulation2d simulation(scene, {.spes = 1});
  step_with(simulation, change<2>(Action::kYield, 0.2f, 1));
  step_with(simulation, change<2>(Action::kCreep, 30));
  EXPECT_EQ(simulation.soft_body(1).settings().plasticity, (ppu::Plasticity{.yield = 0.2f, .creep = 30}));
  EXPECT_FALSE(simulation.soft_body(0).settings().plasticity) << "creep alone makes nothing plastic";
}

TEST(LiveSettings, ABodyOfTooManyParticlesStaysElastic) {
  if (kSlowBuild) GTEST_SKIP() << "to make the scene takes half a minute with sanitizers";
  const Scene scene = load_scene_3d("big");
  Simulation3d run(scene, {.spes = 2});
  ASSERT_GT(run.particles(), 4096u);
  step_with(run, change<3>(Action::kYield, 0.2f));
  for (std::size_t b = 0; b < run.soft_bodies(); ++b)
    EXPECT_EQ(run.soft_body(b).settings().plasticity.has_value(), run.model(b).particles() <= 4096) << b;
}

/// Bodies of one model are stepped by common jobs, as long as they are of one material.
TEST(LiveSettings, OneBodyOfAModelIsChangedAndTheOthersAreNot) {
  Scene scene = load_scene_3d("drop");
  for (int i = 1; i < 4; ++i) {
    scene.soft_bodies.push_back(scene.soft_bodies[0]);
    scene.soft_bodies.back().position.x() +=
        5 * static_cast<float>(i);  // still above the floor, or beside it
  }
  std::vector<std::uint64_t> hashes;
  for (const int spes : {1, 2, 6}) {
    Simulation3d changed(scene, {.spes = spes}), unchanged(scene, {.spes = spes});
    step(changed, 20), step(unchanged, 20);
    step_with(changed, change<3>(Action::kAlpha, 0.9f, 2));
    unchanged.step();
    step(changed, 20), step(unchanged, 20);
    for (std::size_t b = 0; b < 4; ++b) {
      const auto x = changed.soft_body(b).positions(), y = unchanged.soft_body(b).positions();
      EXPECT_EQ(std::equal(x.begin(), x.end(), y.begin()), b != 2)
          << "body " << b << " on " << spes << " SPEs";
    }
    hashes.push_back(changed.state_hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(LiveSettings, StifferBodiesAreDeformedLess) {
  const Scene scene = load_scene_3d("drop");
  std::vector<float> deformations;
  for (const float modulus : {60.0f, 300.0f, 1500.0f}) {
    Simulation3d simulation(scene, {.spes = 2});
    step_with(simulation, change<3>(Action::kModulus, modulus));
    step(simulation, 240);
    deformations.push_back(simulation.soft_body(0).deformation());
  }
  EXPECT_GT(deformations[0], 1.5f * deformations[1]);
  EXPECT_GT(deformations[1], 1.5f * deformations[2]);
}

TEST(LiveSettings, SlowMotionIsTheSameMotion) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d slow(scene, {.spes = 2}), usual(scene, {.spes = 2}), fast(scene, {.spes = 2});
  const Scene2d scene_2d = load_scene_2d("stack");
  Simulation2d slow_2d(scene_2d), usual_2d(scene_2d);
  step_with(slow, change<3>(Action::kTimeScale, 0.25f)), step(slow, 159);
  step(usual, 40);
  step_with(fast, change<3>(Action::kTimeScale, 2)), step(fast, 19);
  EXPECT_EQ(slow.state_hash(), usual.state_hash());
  EXPECT_EQ(fast.state_hash(), usual.state_hash());
  step_with(slow_2d, change<2>(Action::kTimeScale, 0.25f)), step(slow_2d, 159);
  step(usual_2d, 40);
  EXPECT_EQ(slow_2d.state_hash(), usual_2d.state_hash());
}

TEST(LiveSettings, ARecordingRefusesNumbersOutOfTheirRange) {
  const std::string head = "softcell recording 1\ndimension 3\nscene drop\nscene_hash 0000000000000001\n";
  const auto refusal = [&](const std::string& line) -> std::string {
    try {
      parse_recording<3>(head + line + "\nframes 9\n");
    } catch (const std::runtime_error& refused) {
      return refused.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("0 alpha all 1.5"), "line 5: alpha is 1.5; it must be a number from 0 to 1");
  EXPECT_EQ(refusal("0 substeps 2.5"), "line 5: substeps is 2.5; it must be a whole number from 1 to 64");
  EXPECT_EQ(refusal("0 substeps 65"), "line 5: substeps is 65; it must be a whole number from 1 to 64");
  EXPECT_EQ(refusal("0 substeps 64").find("substeps"), std::string::npos) << "a scene file may have as many";
  EXPECT_EQ(refusal("0 time_scale 0"), "line 5: time_scale is 0; it must be a number from 0.02 to 4");
  EXPECT_EQ(refusal("0 damping all"), "line 5: a number is missing");
}

}  // namespace
}  // namespace softcell::demos
