// Scenes of two dimensions whose bodies break or are cut.
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "input/recording.h"
#include "scene/scene_hash.h"
#include "scene_file/change_scene.h"
#include "scene_file/save_scene.h"
#include "scene_file/scene_library.h"
#include "simulation_runs.h"
#include "softcell/render/offscreen_context.h"
#include "support/scratch_folder.h"
#include "view/scene_view_2d.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2f;

InputEvent<2> stroke_2d(const Vector2f& from, const Vector2f& way) {
  InputEvent<2> event;
  event.action = Action::kCut;
  event.body = kEveryBody;
  event.value = from;
  event.way = way;
  return event;
}

TEST(BrokenBodies2d, TheManLosesAnArmAndTheSameOneAgainAfterAReset) {
  const Scene2d scene = load_scene_2d("man_breaks");
  Simulation2d run(scene, {});
  const std::size_t particles = run.particles();
  step(run, 80);
  const std::uint64_t first = run.state_hash();
  ASSERT_GE(run.soft_bodies(), 2u);
  // The arm that hangs is a piece with the hand; the man has his head.
  std::size_t with_hand = 0, with_head = 0;
  for (std::size_t b = 0; b < run.soft_bodies(); ++b) {
    EXPECT_EQ(run.source(b), 0u);
    for (const Eigen::Vector2i& cell : run.soft_body(b).model().lattice().cells) {
      if (cell == Eigen::Vector2i(0, 9)) with_hand = b;
      if (cell == Eigen::Vector2i(7, 14)) with_head = b;
    }
  }
  EXPECT_NE(with_hand, with_head);
  EXPECT_GT(run.soft_body(with_hand).centre_of_mass().y(), run.soft_body(with_head).centre_of_mass().y() + 1);
  InputEvent<2> reset;
  reset.action = Action::kReset;
  run.step({&reset, 1});
  EXPECT_EQ(run.soft_bodies(), 1u);
  EXPECT_EQ(run.particles(), particles);
  step(run, 79);
  EXPECT_EQ(run.state_hash(), first);
}

TEST(BrokenBodies2d, HaveTheSameBitsForAnyNumberOfSpesAndSchedule) {
  const Scene2d scene = load_scene_2d("man_breaks");
  std::set<std::uint64_t> hashes;
  for (const auto& [spes, schedule] : {std::pair(1, "eager"), std::pair(2, "random:5"), std::pair(3, "lazy"),
                                       std::pair(4, "eager"), std::pair(5, "eager"), std::pair(6, "lazy")}) {
    Simulation2d run(scene, {.spes = spes, .schedule = dma::parse_schedule(schedule)});
    step(run, 90);
    EXPECT_GE(run.soft_bodies(), 2u);
    hashes.insert(run.state_hash());
  }
  EXPECT_EQ(hashes.size(), 1u);
}

/// The recording goes through its text; hands hold what is cut.
TEST(BrokenBodies2d, CutsAndHandsAreReplayedToTheSameBits) {
  const Scene2d scene = load_scene_2d("man");
  Recording<2> recording{.scene = "man", .frames = 60};
  InputEvent<2> hold;
  hold.action = Action::kHold;
  hold.hand = kUsersHand;
  hold.body = 0;
  hold.value = {1.5f, 0.4f};  // his hand
  recording.events.push_back({2, hold});
  recording.events.push_back({12, stroke_2d({0.9f, 2}, {0.1f, -4})});
  InputEvent<2> move = hold;
  move.action = Action::kMoveHand;
  move.body = 0;
  move.value = {2.5f, 1.5f};
  recording.events.push_back({20, move});
  const Recording<2> again = parse_recording<2>(to_text(recording));
  EXPECT_EQ(again, recording);
  std::set<std::uint64_t> hashes;
  for (const int spes : {1, 6}) {
    Simulation2d run(scene, {.spes = spes});
    std::size_t next = 0;
    for (int frame = 0; frame < 60; ++frame) {
      std::vector<InputEvent<2>> events;
      while (next < again.events.size() && again.events[next].frame == frame)
        events.push_back(again.events[next++].event);
      run.step(events);
    }
    hashes.insert(run.state_hash());
    ASSERT_EQ(run.soft_bodies(), 2u);
    // The hand goes on with the piece of the arm.
    Shown2d shown;
    run.show(shown);
    ASSERT_EQ(shown.hands.size(), 1u);
    EXPECT_LT((shown.hands[0][0] - Vector2f(2.5f, 1.5f)).norm(), 0.3f);
    const Vector2f arm = run.soft_body(1).centre_of_mass();
    EXPECT_LT((arm - Vector2f(2.5f, 1.5f)).norm(), 0.8f);
    EXPECT_LT(run.soft_body(0).centre_of_mass().y(), 0);
  }
  EXPECT_EQ(hashes.size(), 1u);
}

TEST(BrokenBodies2d, AHandAtAParticleGoesOnWithItsPiece) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d run(scene, {});
  InputEvent<2> grab;
  grab.action = Action::kGrab;
  grab.hand = 5;
  grab.body = 0;
  grab.value = {1.6f, 0.4f};
  run.step({&grab, 1});
  const InputEvent<2> cut = stroke_2d({0.9f, 2}, {0.1f, -4});
  run.step({&cut, 1});
  step(run, 10);
  ASSERT_EQ(run.soft_bodies(), 2u);
  ASSERT_EQ(run.held().size(), 1u);
  EXPECT_EQ(run.held()[0].body, 1u);
  EXPECT_LT((run.soft_body(1).position(run.held()[0].particle) - Vector2f(1.6f, 0.4f)).norm(), 0.3f);
  InputEvent<2> home;
  home.action = Action::kHome;
  home.body = 1;
  run.step({&home, 1});
  EXPECT_EQ(run.soft_bodies(), 1u) << "a piece that goes home makes its body whole";
  EXPECT_TRUE(run.held().empty());
  step(run, 5);
}

TEST(BrokenBodies2d, AreCutAtOnceInAPauseAndByAStrokeOfNoLengthNotAtAll) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d run(scene, {});
  InputEvent<2> pause;
  pause.action = Action::kPause;
  const std::vector<InputEvent<2>> nothing{pause, stroke_2d({0.9f, 2}, {0, 0})};
  run.step(nothing);
  EXPECT_EQ(run.soft_bodies(), 1u);
  const InputEvent<2> cut = stroke_2d({0.9f, 2}, {0.1f, -4});
  run.step({&cut, 1});
  EXPECT_EQ(run.soft_bodies(), 2u);
  const auto softer = change<2>(Action::kAlpha, 0.25f, 0);
  run.step({&softer, 1});
  for (std::size_t b = 0; b < 2; ++b) EXPECT_EQ(run.soft_body(b).settings().alpha, 0.25f);
  try {
    run.moment();
    FAIL() << "the moment of a run in which a body was cut";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(
        error.what(),
        "the scene man cannot be saved or changed: 'man' has broken, and a scene file has whole bodies only; "
        "reset the scene first");
  }
}

/// The view follows bodies that come, change and go; a man without cuts looks as one that was made whole again.
TEST(BrokenBodies2d, AreDrawnFromTheFrameInWhichTheyBrokeUntilTheyAreWhole) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d run(scene, {});
  const auto context = render::create_offscreen_context();
  render::Renderer renderer(*context, {.width = 240, .height = 135});
  SceneView2d view(scene, run, renderer, View2d::kFilled);
  InputEvent<2> pause, home;
  pause.action = Action::kPause;
  home.action = Action::kHome;
  home.body = 0;
  run.step({&pause, 1});
  const render::Image before = view.draw();
  const InputEvent<2> cut = stroke_2d({0.9f, 2}, {0.1f, -4});
  run.step({&cut, 1});
  ASSERT_EQ(run.soft_bodies(), 2u);
  const render::Image after = view.draw();
  std::size_t differ = 0;
  for (std::size_t i = 0; i < before.rgba.size(); i += 4)
    differ += std::abs(int{before.rgba[i]} - int{after.rgba[i]}) > 16 ? 1 : 0;
  EXPECT_GT(differ, 5u) << "a line where the cut is";
  EXPECT_LT(differ, 200u) << "and nothing else: pieces are drawn where the whole was";
  run.step({&home, 1});
  EXPECT_EQ(view.draw().rgba, before.rgba);
}

Scene2d scene_of(const std::string& more) {
  return std::get<Scene2d>(parse_scene(
      "dimension = 2\n[[soft_body]]\nrows = [\"########\", \"########\"]\ncell_size = 0.2\n" + more, "t"));
}

TEST(BrokenBodies2d, AreCutWhenTheSceneSaysSo) {
  const Scene2d scene = scene_of(
      "[[cut]]\ntime = 0.05\nbody = \"body 1\"\npoint = [0.21, 0]\nnormal = [1, 0]\n"
      "[[cut]]\ntime = 0.2\nbody = \"body 1\"\npoint = [-0.39, -9]\nway = [0, 90]\n");
  ASSERT_EQ(scene.cuts.size(), 2u);
  Simulation2d run(scene, {});
  step(run, 3);
  EXPECT_EQ(run.soft_bodies(), 1u);
  step(run, 5);
  EXPECT_EQ(run.soft_bodies(), 2u);
  step(run, 10);
  EXPECT_EQ(run.soft_bodies(), 3u);
  EXPECT_EQ(run.source(2), 0u);
  // A recording belongs to this scene, and not to one that is cut elsewhere.
  EXPECT_NE(scene_hash(scene), scene_hash(scene_of("")));
}

TEST(BrokenBodies2d, AreWeakWhereTheSceneSaysSo) {
  const std::string brittle = "fracture = { stretch = 0.5 }\n";
  const std::string weak =
      "[[soft_body.strength]]\npoint = [0.1, 0]\nnormal = [1, 0]\nthickness = 0.1\nfactor = 0.1\n";
  const std::string pull =
      "[[drag]]\nbegin = 0\nend = 2\nbody = \"body 1\"\nfrom = [-0.8, 0]\nto = [-2, 0]\n"
      "[[drag]]\nbegin = 0\nend = 2\nbody = \"body 1\"\nfrom = [0.8, 0]\nto = [2, 0]\n";
  const Scene2d scene = scene_of(brittle + weak + pull), strong = scene_of(brittle + pull);
  ASSERT_EQ(scene.soft_bodies[0].strengths.size(), 1u);
  EXPECT_NE(scene_hash(scene), scene_hash(strong));
  Simulation2d run(scene, {}), whole(strong, {});
  for (int frame = 0; frame < 120 && run.soft_bodies() == 1; ++frame) run.step(), whole.step();
  ASSERT_GE(run.soft_bodies(), 2u);
  EXPECT_EQ(whole.soft_bodies(), 1u);
  for (const Eigen::Vector2i& cell : run.soft_body(0).model().lattice().cells) EXPECT_LE(cell.x(), 4);
}

/// Hands of both kinds at what a cut leaves too small to stay.
TEST(BrokenBodies2d, HandsLetGoOfWhatVanishes) {
  for (const Action action : {Action::kHold, Action::kGrab}) {
    const Scene2d scene = scene_of("fracture = { least_cells = 1000 }\n");
    Simulation2d run(scene, {});
    const std::size_t cells = run.soft_body(0).model().lattice().cells.size();
    InputEvent<2> take;
    take.action = action;
    take.hand = kUsersHand;
    take.body = 0;
    take.value = {0.8f, 0};  // the end that is cut off
    run.step({&take, 1});
    Shown2d shown;
    run.show(shown);
    EXPECT_EQ(shown.hands.size(), 1u);
    const InputEvent<2> stroke = stroke_2d({0.41f, 9}, {0, -90});
    run.step({&stroke, 1});
    step(run, 10);
    EXPECT_EQ(run.soft_bodies(), 1u);
    EXPECT_LT(run.soft_body(0).model().lattice().cells.size(), cells);
    run.show(shown);
    EXPECT_TRUE(shown.hands.empty());
    InputEvent<2> reset;
    reset.action = Action::kReset;
    run.step({&reset, 1});
    EXPECT_EQ(run.soft_body(0).model().lattice().cells.size(), cells);
    run.step({&take, 1});
    step(run, 5);
  }
}

TEST(BrokenBodies2d, AHandOnWhatStaysHoldsOn) {
  const Scene2d scene = scene_of("fracture = { least_cells = 1000 }\n");
  Simulation2d run(scene, {});
  InputEvent<2> take;
  take.action = Action::kHold;
  take.hand = kUsersHand;
  take.body = 0;
  take.value = {-0.8f, 0};
  run.step({&take, 1});
  const InputEvent<2> stroke = stroke_2d({0.41f, 9}, {0, -90});
  run.step({&stroke, 1});
  step(run, 10);
  Shown2d shown;
  run.show(shown);
  ASSERT_EQ(shown.hands.size(), 1u);
}

TEST(BrokenBodies2d, OfScenesWithOtherLeastCellsHaveOtherHashes) {
  const auto hash = [](const std::string& fracture) { return scene_hash(scene_of(fracture)); };
  EXPECT_EQ(hash("fracture = { stretch = 0.5 }\n"), hash("fracture = { stretch = 0.5, least_cells = 1 }\n"));
  EXPECT_NE(hash("fracture = { stretch = 0.5 }\n"), hash("fracture = { stretch = 0.5, least_cells = 2 }\n"));
}

TEST(BrokenBodies2d, ScenesThatCutNothingAreRefused) {
  const auto refusal = [](const std::string& more) -> std::string {
    try {
      scene_of(more);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  const std::string cut = "[[cut]]\ntime = 1\nbody = \"body 1\"\npoint = [0, 0]\n";
  EXPECT_NE(refusal(cut).find("cut 1 needs either the field 'normal' or the field 'way'"), std::string::npos)
      << refusal(cut);
  EXPECT_NE(refusal(cut + "normal = [0, 0]\n").find("normal of cut 1 must not be 0"), std::string::npos);
  EXPECT_NE(refusal(cut + "way = [0, 0]\n").find("way of cut 1 must not be 0"), std::string::npos);
  EXPECT_NE(refusal(cut + "normal = [1, 0]\nway = [1, 0]\n")
                .find("cut 1 has the field 'normal', so it may not have 'way'"),
            std::string::npos);
  EXPECT_NE(refusal(cut + "edge = [1, 0]\nway = [1, 0]\n"), "");
}

TEST(BrokenBodies2d, AreSavedWithTheirStrengthsAndCuts) {
  const tests::ScratchFolder folder;
  const Scene2d scene = scene_of(
      "fracture = { stretch = 0.5, turn = 20, least_cells = 3 }\n"
      "[[soft_body.strength]]\npoint = [0.1, 0]\nnormal = [1, 0]\nthickness = 0.1\nfactor = 0.1\n"
      "[[cut]]\ntime = 5\nbody = \"body 1\"\npoint = [0.21, 0]\nnormal = [1, 0]\n");
  Simulation2d run(scene, {});
  step(run, 5);
  const auto file = folder.path() / "saved.toml";
  write_scene_files(saved_scene(scene, present(run), run.contacts(), file));
  const Scene2d loaded = load_scene_2d(file.string());
  EXPECT_EQ(loaded.soft_bodies[0].settings, scene.soft_bodies[0].settings);
  EXPECT_EQ(loaded.soft_bodies[0].settings.fracture->least_cells, 3u);
  EXPECT_EQ(loaded.soft_bodies[0].strengths, scene.soft_bodies[0].strengths);
  ASSERT_EQ(loaded.cuts.size(), 1u);
  EXPECT_EQ(loaded.cuts[0].where.from, scene.cuts[0].where.from);
  Scene2d less = scene_now(scene, present(run));
  remove_body(less, 0);
  EXPECT_TRUE(less.cuts.empty());
}

}  // namespace
}  // namespace softcell::demos
