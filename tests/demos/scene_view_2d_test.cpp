// In two dimensions only what has moved is drawn anew: the pictures are those of drawing everything.

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "scene_file/scene_library.h"
#include "simulation/simulation_2d.h"
#include "softcell/render/image_compare.h"
#include "softcell/render/offscreen_context.h"
#include "view/scene_view_2d.h"

namespace softcell::demos {
namespace {

constexpr render::RendererSettings kSettings{.width = 240, .height = 135};

class ScenesIn2d : public testing::TestWithParam<const char*> {
 protected:
  /// The picture of somebody who has drawn nothing before.
  render::Image whole(const Simulation2d& simulation, View2d view) {
    return SceneView2d(scene_, simulation, other_, view).draw();
  }

  const Scene2d scene_ = load_scene_2d(GetParam());
  const std::unique_ptr<render::GlContext> context_ = render::create_offscreen_context();
  render::Renderer other_{*context_, kSettings};
};

TEST_P(ScenesIn2d, LookAsIfAllWereDrawn) {
  for (const View2d view : {View2d::kFilled, View2d::kDots, View2d::kLattice}) {
    Simulation2d simulation(scene_);
    render::Renderer renderer(*context_, kSettings);
    SceneView2d drawn(scene_, simulation, renderer, view);
    for (int frame = 0; frame < 40; ++frame) {
      // A hand that drags something about, and lets go: it, its link and its shadow leave no trace.
      std::vector<InputEvent<2>> events;
      if (frame == 5) events.push_back({.action = Action::kGrab, .hand = kUsersHand, .body = kEveryBody});
      if (frame == 6) events.push_back({.action = Action::kMoveHand, .hand = kUsersHand, .value = {2, 1}});
      if (frame == 30) events.push_back({.action = Action::kRelease, .hand = kUsersHand});
      simulation.step(events);
      const render::Image& picture = drawn.draw();
      if (frame % 8 == 7) {
        const render::Image expected = whole(simulation, view);
        EXPECT_EQ(picture, expected) << "frame " << frame << ": "
                                     << render::describe(render::compare(picture, expected));
      }
    }
  }
}

TEST_P(ScenesIn2d, LookAsIfAllWereDrawnAfterAnotherViewAndSize) {
  Simulation2d simulation(scene_);
  render::Renderer renderer(*context_, kSettings);
  SceneView2d drawn(scene_, simulation, renderer, View2d::kFilled);
  Shown2d shown;
  simulation.show(shown);
  drawn.draw(shown, {.view = static_cast<int>(View2d::kFilled)});
  drawn.draw(shown, {.view = static_cast<int>(View2d::kDots)});
  EXPECT_EQ(renderer.pixels(), whole(simulation, View2d::kDots));
  renderer.resize(120, 90);
  drawn.draw(shown, {.view = static_cast<int>(View2d::kDots)});
  renderer.resize(kSettings.width, kSettings.height);
  drawn.draw(shown, {.view = static_cast<int>(View2d::kDots)});
  EXPECT_EQ(renderer.pixels(), whole(simulation, View2d::kDots));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ScenesIn2d, testing::Values("man", "stack", "two_way"));

TEST(Moved2d, IsTheOldAndTheNewPlaceOfWhatMoves) {
  Scene2d scene;
  scene.rigid_bodies.resize(2);
  scene.rigid_bodies[0].shape = CircleShape{.radius = 0.5f};
  scene.rigid_bodies[1].shape = Box2dShape{.size = {6, 8}};
  Shown2d shown{.particles = {}, .rigid_poses = {{.position = {1, 0}}, {.position = {9, 9}}}, .hands = {}};
  Moved2d moved(scene);
  const Moved2d::Box none;
  moved.since_last(shown, none);
  EXPECT_TRUE(moved.since_last(shown, none).isEmpty());

  shown.rigid_poses[0].position = {3, 1};
  const Moved2d::Box box = moved.since_last(shown, none);
  EXPECT_EQ(box.min(), Eigen::Vector2f(0.5f, -0.5f));
  EXPECT_EQ(box.max(), Eigen::Vector2f(3.5f, 1.5f));

  shown.rigid_poses[1].sine = 0.1f;  // half the diagonal of 6 by 8
  const Moved2d::Box turned = moved.since_last(shown, none);
  EXPECT_EQ(turned.min(), Eigen::Vector2f(4, 4));
  EXPECT_EQ(turned.max(), Eigen::Vector2f(14, 14));
  EXPECT_TRUE(moved.since_last(shown, none).isEmpty());
}

// What makes sixty pictures a second without a GPU.
TEST(Moved2d, IsLittleOfThePictureOfTheMan) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d simulation(scene);
  Moved2d moved(scene);
  const Eigen::Vector2f radius = Eigen::Vector2f::Constant(simulation.soft_body(0).model().contact_radius());
  Shown2d shown;
  const float picture = scene.camera.height * scene.camera.height * 16 / 9;
  for (int frame = 0; frame < 120; ++frame) {
    simulation.step();
    simulation.show(shown);
    Moved2d::Box man;
    for (const Eigen::Vector2f& particle : shown.particles[0])
      man.extend(Moved2d::Box(particle - radius, particle + radius));
    const Moved2d::Box box = moved.since_last(shown, man);
    if (frame > 0) {
      EXPECT_LT(box.volume(), 0.4f * picture) << "frame " << frame;
    }
  }
}

TEST(Moved2d, TakesSoftBodiesAndHandsForRestless) {
  Shown2d shown;
  const Scene2d scene;
  Moved2d moved(scene);
  const Moved2d::Box soft(Eigen::Vector2f(0.75f, 0.75f), Eigen::Vector2f(2.25f, 1.25f));
  moved.since_last(shown, soft);
  const Moved2d::Box still = moved.since_last(shown, soft);
  EXPECT_EQ(still.min(), soft.min());
  EXPECT_EQ(still.max(), soft.max());

  shown.hands.push_back({Eigen::Vector2f(1, 1), Eigen::Vector2f(-3, 5)});
  moved.since_last(shown, soft);
  shown.hands.clear();
  const Moved2d::Box let_go = moved.since_last(shown, soft);  // where the hand was
  EXPECT_EQ(let_go.min(), Eigen::Vector2f(-3, 0.75f));
  EXPECT_EQ(let_go.max(), Eigen::Vector2f(2.25f, 5));
}

}  // namespace
}  // namespace softcell::demos
