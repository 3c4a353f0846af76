// Scenes whose bodies break or are cut: what a simulation, its hands and its view make of pieces.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "input/recording.h"
#include "scene_file/save_scene.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "simulation_runs.h"
#include "softcell/render/offscreen_context.h"
#include "view/scene_view.h"

namespace softcell::demos {
namespace {

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

/// Downwards through x = `x`, from the user's eye at z = 10, over the whole height of what one sees.
InputEvent<3> stroke_at(float x, float half_height = 5) {
  const Eigen::Vector3f eye(x, 1, 10);
  return {.action = Action::kCut,
          .body = kEveryBody,
          .value = eye,
          .edge = Eigen::Vector3f(0, half_height, -10) * 10,
          .way = Eigen::Vector3f(0, -half_height, -10) * 10};
}

ppu::Bounds<3> bounds_of(const Simulation3d& run, std::size_t body) { return run.soft_body(body).bounds(); }

TEST(TheUsersKnife, CutsWhatIsUnderItAlsoWhatIsNotBrittle) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d run(scene, {});
  ASSERT_FALSE(run.soft_body(0).settings().fracture);
  run.step();
  const float middle = 0.5f * (bounds_of(run, 0).low + bounds_of(run, 0).high).x();
  const InputEvent<3> beside = stroke_at(bounds_of(run, 0).high.x() + 1);
  run.step({&beside, 1});
  EXPECT_EQ(run.soft_bodies(), 1u) << "a stroke beside the body";
  const InputEvent<3> through = stroke_at(middle);
  run.step({&through, 1});
  step(run, 2);  // pieces come some substeps later
  ASSERT_EQ(run.soft_bodies(), 2u);
  const float cell = run.soft_body(0).settings().cell_size;
  for (std::size_t b = 0; b < 2; ++b)
    EXPECT_TRUE(bounds_of(run, b).low.x() > middle - cell || bounds_of(run, b).high.x() < middle + cell)
        << "piece " << b << " lies on both sides";
  EXPECT_EQ(run.source(1), 0u);
  step(run, 60);
  EXPECT_TRUE(bounds_of(run, 1).high.allFinite());
  const InputEvent<3> home{.action = Action::kHome, .body = kEveryBody};
  run.step({&home, 1});
  EXPECT_EQ(run.soft_bodies(), 1u) << "whole again";
}

TEST(TheUsersKnife, CutsAtOnceInAPause) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d run(scene, {});
  run.step();
  const float middle = 0.5f * (bounds_of(run, 0).low + bounds_of(run, 0).high).x();
  const std::vector<InputEvent<3>> events{{.action = Action::kPause}, stroke_at(middle)};
  run.step(events);
  Shown3d shown;
  run.show(shown);
  EXPECT_EQ(shown.bodies.size(), 2u);
}

TEST(TheUsersKnife, CutsNothingWithoutAnAreaOrWhereBodiesTouchWithSpheres) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d run(scene, {}), spheres(scene, {.contacts = ppu::ContactMethod::kSpheres});
  run.step(), spheres.step();
  const float middle = 0.5f * (bounds_of(run, 0).low + bounds_of(run, 0).high).x();
  InputEvent<3> flat = stroke_at(middle), none = flat;
  flat.way = 2 * flat.edge;
  none.edge.setZero();
  const std::vector<InputEvent<3>> events{flat, none};
  run.step(events);
  EXPECT_EQ(run.soft_bodies(), 1u);
  const InputEvent<3> through = stroke_at(middle);
  spheres.step({&through, 1});
  EXPECT_EQ(spheres.soft_bodies(), 1u);
}

/// The recording goes through its text.
TEST(TheUsersKnife, IsReplayedToTheSameBitsOnAnyNumberOfSpes) {
  const Scene scene = load_scene_3d("drop");
  Recording<3> recording{.scene = "drop", .frames = 60};
  std::set<std::uint64_t> hashes;
  std::size_t pieces = 0;
  {
    Simulation3d run(scene, {.spes = 2});
    for (int frame = 0; frame < 60; ++frame) {
      std::vector<InputEvent<3>> events;
      if (frame == 10 || frame == 30) {
        const ppu::Bounds<3> box = bounds_of(run, 0);
        events.push_back(
            stroke_at(box.low.x() + 0.37f * (box.high.x() - box.low.x()), frame == 10 ? 5.0f : 0.7f));
        events.back().way.x() += 1.0f / 3;
        recording.events.push_back({frame, events[0]});
      }
      run.step(events);
    }
    hashes.insert(run.state_hash());
    pieces = run.soft_bodies();
  }
  EXPECT_GE(pieces, 2u);
  const Recording<3> again = parse_recording<3>(to_text(recording));
  EXPECT_EQ(again, recording);
  for (const int spes : {1, 6}) {
    Simulation3d run(scene, {.spes = spes, .schedule = dma::parse_schedule(spes == 1 ? "lazy" : "random:3")});
    std::size_t next = 0;
    for (int frame = 0; frame < 60; ++frame) {
      std::vector<InputEvent<3>> events;
      while (next < again.events.size() && again.events[next].frame == frame)
        events.push_back(again.events[next++].event);
      run.step(events);
    }
    hashes.insert(run.state_hash());
    EXPECT_EQ(run.soft_bodies(), pieces);
  }
  EXPECT_EQ(hashes.size(), 1u);
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
