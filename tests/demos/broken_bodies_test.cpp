// Scenes whose bodies break or are cut: what a simulation, its hands and its view make of pieces.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene_file/save_scene.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "softcell/render/offscreen_context.h"
#include "view/scene_view.h"

namespace softcell::demos {
namespace {

void step(Simulation3d& simulation, int frames) {
  for (int i = 0; i < frames; ++i) simulation.step();
}

TEST(BrokenBodies, AVaseBreaksTheSameWayAgainAfterAReset) {
  const Scene scene = load_scene_3d("break");
  Simulation3d run(scene, {});
  const std::size_t particles = run.particles();
  step(run, 55);
  const std::uint64_t first = run.state_hash();
  const std::size_t pieces = run.soft_bodies();
  ASSERT_GT(pieces, 5u);
  for (std::size_t b = 0; b < pieces; ++b) EXPECT_EQ(run.source(b), 0u);
  const InputEvent<3> reset{.action = Action::kReset};
  run.step({&reset, 1});
  EXPECT_EQ(run.soft_bodies(), 1u);
  EXPECT_EQ(run.particles(), particles);
  const InputEvent<3> push{.action = Action::kPush, .body = 0, .value = scene.script.impulses[0].velocity};
  run.step({&reset, 1});  // and again, of a body that is whole; the impulse of the scene's beginning has been
  std::vector<InputEvent<3>> events{reset, push};
  run.step(events);
  step(run, 54);
  EXPECT_EQ(run.soft_bodies(), pieces);
  EXPECT_EQ(run.state_hash(), first);
}

TEST(BrokenBodies, HaveTheSameBitsForAnyNumberOfSpes) {
  const Scene scene = load_scene_3d("break");
  std::set<std::uint64_t> hashes;
  for (const int spes : {1, 3, 6}) {
    Simulation3d run(scene, {.spes = spes});
    step(run, 50);
    EXPECT_GT(run.soft_bodies(), 5u);
    hashes.insert(run.state_hash());
  }
  EXPECT_EQ(hashes.size(), 1u);
}

TEST(BrokenBodies, AreShownWithTheirOwnMeshesFromTheFrameInWhichTheyBroke) {
  const Scene scene = load_scene_3d("cut");
  Simulation3d run(scene, {});
  step(run, 48);
  ASSERT_EQ(run.soft_bodies(), 1u);
  // Its pieces come some substeps after the cut.
  for (int frame = 0; frame < 3 && run.soft_bodies() == 1; ++frame) run.step();
  ASSERT_EQ(run.soft_bodies(), 2u);
  Shown3d shown;
  run.show(shown);
  ASSERT_EQ(shown.bodies.size(), 2u);
  for (std::size_t b = 0; b < 2; ++b) {
    EXPECT_EQ(shown.bodies[b].model, run.soft_body(b).shared_model());
    EXPECT_EQ(shown.bodies[b].source, 0u);
    EXPECT_EQ(shown.bodies[b].vertices.size(), 4 * run.model(b).embedding().groups.size());
    EXPECT_EQ(shown.bodies[b].particles.size(), run.model(b).particles());
  }
  // Half through: another model, and no piece.
  step(run, 120);
  ASSERT_EQ(run.soft_bodies(), 4u);
  const std::size_t particles = run.model(0).particles();
  step(run, 50);
  EXPECT_EQ(run.soft_bodies(), 4u);
  EXPECT_GT(run.model(0).particles(), particles);
}

/// A hand at a particle, and one that holds a patch, when what they hold is cut.
TEST(BrokenBodies, SlipOutOfHands) {
  const Scene scene = load_scene_3d("cut");
  Simulation3d run(scene, {});
  step(run, 30);
  const std::vector<InputEvent<3>> hands{
      {.action = Action::kGrab, .hand = 5, .body = 0, .value = run.soft_body(0).bounds().high},
      {.action = Action::kHold, .hand = 6, .body = 0, .value = run.soft_body(0).bounds().high}};
  run.step(hands);
  step(run, 60);
  EXPECT_GE(run.soft_bodies(), 2u);
  const std::vector<InputEvent<3>> moves{{.action = Action::kMoveHand, .hand = 5, .value = {0, 5, 0}},
                                         {.action = Action::kMoveHand, .hand = 6, .value = {0, 5, 0}},
                                         {.action = Action::kHome, .body = 1}};
  run.step(moves);
  EXPECT_EQ(run.soft_bodies(), 1u) << "a piece that goes home makes its body whole";
  step(run, 5);
}

TEST(BrokenBodies, HaveTheMaterialOfTheirBodyAlsoWhenItChanges) {
  const Scene scene = load_scene_3d("cut");
  Simulation3d run(scene, {});
  step(run, 60);
  ASSERT_EQ(run.soft_bodies(), 2u);
  const InputEvent<3> softer{.action = Action::kAlpha, .body = 0, .value = {0.25f, 0, 0}};
  run.step({&softer, 1});
  for (std::size_t b = 0; b < 2; ++b) EXPECT_EQ(run.soft_body(b).settings().alpha, 0.25f);
}

TEST(BrokenBodies, AreNotSaved) {
  const Scene scene = load_scene_3d("cut");
  Simulation3d run(scene, {});
  step(run, 60);
  try {
    run.moment();
    FAIL() << "the moment of a run in which a body was cut";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "the scene cut cannot be saved or changed: 'loaf' has broken, and a scene file has whole "
                 "bodies only; reset the "
                 "scene first");
  }
  const InputEvent<3> reset{.action = Action::kReset};
  run.step({&reset, 1});
  EXPECT_EQ(run.moment().soft_bodies.size(), 1u);
}

/// The view follows bodies that come, change and go.
TEST(BrokenBodies, AreDrawnWithTheGpuAsWithTheSpes) {
  const Scene scene = load_scene_3d("cut");
  std::vector<render::Image> pictures;
  for (const Skin skin : {Skin::kSpe, Skin::kGpu}) {
    Simulation3d run(scene, {.skin = skin});
    const auto context = render::create_offscreen_context();
    render::Renderer renderer(*context, {.width = 240, .height = 135});
    SceneView view(scene, run, renderer, View::kMesh);
    for (int frame = 0; frame < 70; ++frame) {
      run.step();
      if (frame % 10 == 5) view.draw();
    }
    run.finish();
    pictures.push_back(view.draw());
    const InputEvent<3> reset{.action = Action::kReset};
    run.step({&reset, 1});
    view.draw();
  }
  std::size_t differ = 0;
  for (std::size_t i = 0; i < pictures[0].rgba.size(); ++i)
    differ += std::abs(int{pictures[0].rgba[i]} - int{pictures[1].rgba[i]}) > 24 ? 1 : 0;
  EXPECT_LT(differ, pictures[0].rgba.size() / 200);
}

}  // namespace
}  // namespace softcell::demos
