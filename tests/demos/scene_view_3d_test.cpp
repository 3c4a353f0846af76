// In three dimensions, too, only what has moved is drawn anew, and walls do not hide what is behind them.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "softcell/render/image_compare.h"
#include "softcell/render/offscreen_context.h"
#include "support/slow_build.h"
#include "view/moved_3d.h"
#include "view/scene_view.h"

namespace softcell::demos {
namespace {

using Eigen::Vector3f;

constexpr render::RendererSettings kManySamples{.width = 240, .height = 135};
constexpr render::RendererSettings kOneSample{.width = 240,
                                              .height = 135,
                                              .samples = 1,
                                              .occlusion_pixels = 4,
                                              .soft_shadows = false,
                                              .coarse_pixels = 12};

struct Drawn {
  const char* scene;
  int first;  ///< frame from which on it is drawn
  render::RendererSettings settings;
};
void PrintTo(const Drawn& d, std::ostream* out) { *out << d.scene << ' ' << d.settings.samples; }

class ScenesIn3d : public testing::TestWithParam<Drawn> {};

TEST_P(ScenesIn3d, LookAsIfAllWereDrawn) {
  if (kSlowBuild && GetParam().first > 10)
    GTEST_SKIP() << "too slow with sanitizers, which run the early moments";
  const Scene scene = load_scene_3d(GetParam().scene);
  Simulation3d simulation(scene, {});
  for (int frame = 0; frame < GetParam().first; ++frame) simulation.step();
  const auto context = render::create_offscreen_context();
  render::Renderer renderer(*context, GetParam().settings), other(*context, GetParam().settings);
  SceneView drawn(scene, simulation, renderer, View::kMesh);
  for (int frame = 0; frame < 24; ++frame) {
    simulation.step();
    simulation.finish();
    const render::Image& picture = drawn.draw();
    if (frame % 8 != 7) continue;
    const render::Image expected = SceneView(scene, simulation, other, View::kMesh).draw();
    EXPECT_EQ(picture, expected) << "frame " << frame << ": "
                                 << render::describe(render::compare(picture, expected));
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ScenesIn3d,
                         testing::Values(Drawn{"press", 30, kManySamples}, Drawn{"press", 30, kOneSample},
                                         Drawn{"bridge", 50, kManySamples}, Drawn{"drop", 10, kOneSample},
                                         Drawn{"arena", 70, kOneSample}));

TEST(SceneView3d, LooksAsIfAllWereDrawnAfterAnotherViewSizeAndHand) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d simulation(scene, {});
  const auto context = render::create_offscreen_context();
  render::Renderer renderer(*context, kOneSample), other(*context, kOneSample);
  SceneView drawn(scene, simulation, renderer, View::kMesh);
  Shown3d shown;
  simulation.show(shown);
  const Look mesh{.view = static_cast<int>(View::kMesh)}, lattice{.view = static_cast<int>(View::kLattice)};
  const auto expect_as_new = [&](const char* after) {
    drawn.draw(shown, mesh);
    const render::Image picture = renderer.pixels();
    SceneView(scene, simulation, other, View::kMesh).draw(shown, mesh);
    EXPECT_EQ(picture, other.pixels()) << after;
  };
  drawn.draw(shown, mesh);
  drawn.draw(shown, lattice);
  expect_as_new("another view");
  renderer.resize(120, 90);
  drawn.draw(shown, mesh);
  renderer.resize(kOneSample.width, kOneSample.height);
  expect_as_new("another size");
  shown.hands.push_back({Vector3f(0, 1, 0), Vector3f(1, 2, 0)});
  drawn.draw(shown, mesh);
  shown.hands.clear();
  expect_as_new("a hand");
}

/// A camera that sees x and y from -1 to 1 at z = 0, in a light from straight above.
render::FrameDescription frame_of(std::vector<render::StaticDraw>& statics) {
  render::FrameDescription frame;
  frame.camera.eye = {0, 0, 10};
  frame.camera.tan_half_fov_y = 0.1f;
  frame.light.toward = {0, 1, 0};
  frame.statics = statics;
  return frame;
}

TEST(Moved3d, IsTheOldAndTheNewPlaceOfWhatMovesAndItsShadow) {
  std::vector<render::StaticDraw> statics(2);
  statics[1].pose(1, 3) = -0.5f;
  const std::array<Moved3d::Box, 2> meshes{
      Moved3d::Box(Vector3f::Constant(-0.01f), Vector3f::Constant(0.01f)),
      Moved3d::Box(Vector3f(-9, -0.01f, -0.01f), Vector3f(9, 0.01f, 0.01f))};
  Moved3d moved;
  const Moved3d::Extents extents{
      .soft_bodies = {}, .static_meshes = meshes, .picture_width = 200, .picture_height = 200};
  EXPECT_FALSE(moved.since_last(frame_of(statics), extents)) << "there is no last frame";
  std::optional<render::PixelRect> part = moved.since_last(frame_of(statics), extents);
  ASSERT_TRUE(part);
  EXPECT_GE(part->left, part->right) << "nothing has moved";

  statics[0].pose(0, 3) = 0.5f;  // from the middle to the right
  part = moved.since_last(frame_of(statics), extents);
  ASSERT_TRUE(part);
  EXPECT_NEAR(part->left, 99, 5);
  EXPECT_NEAR(part->right, 151, 5);
  EXPECT_NEAR(part->top, 99, 5);
  EXPECT_NEAR(part->bottom, 151, 5) << "the shadow falls on the lower thing";

  render::FrameDescription frame = frame_of(statics);
  frame.camera.eye.x() = 1;
  EXPECT_FALSE(moved.since_last(frame, extents)) << "another camera";
  frame.light.toward.x() = 1;
  EXPECT_FALSE(moved.since_last(frame, extents)) << "another light";
  EXPECT_TRUE(moved.since_last(frame, extents));
  statics[0].pose(2, 3) = 30;  // behind the eye
  EXPECT_FALSE(moved.since_last(frame, extents));
  moved.forget();
  EXPECT_FALSE(moved.since_last(frame, extents));
}

TEST(Moved3d, SoftBodiesAndLatticesAlwaysMove) {
  std::vector<render::StaticDraw> statics;
  render::FrameDescription frame = frame_of(statics);
  const Moved3d::Box body(Vector3f(-0.2f, -0.2f, 0), Vector3f(-0.1f, -0.1f, 0));
  const Moved3d::Extents extents{
      .soft_bodies = std::span(&body, 1), .static_meshes = {}, .picture_width = 200, .picture_height = 200};
  Moved3d moved;
  moved.since_last(frame, extents);
  std::optional<render::PixelRect> part = moved.since_last(frame, extents);
  ASSERT_TRUE(part);
  EXPECT_NEAR(part->left, 80, 5);
  EXPECT_NEAR(part->right, 90, 5);
  EXPECT_NEAR(part->top, 110, 5);
  EXPECT_NEAR(part->bottom, 120, 5);

  const std::array<Vector3f, 2> rope{Vector3f(0.3f, 0.3f, 0), {0.5f, 0.5f, 0}};
  const render::LatticeDraw lattice{.particles = rope, .links = {}, .radius = 0.1f};
  frame.lattices = std::span(&lattice, 1);
  EXPECT_FALSE(moved.since_last(frame, extents)) << "a new thing";
  part = moved.since_last(frame, extents);
  ASSERT_TRUE(part);
  EXPECT_NEAR(part->right, 160, 5);
  EXPECT_NEAR(part->top, 40, 5);
}

/// The picture's middle, of a framework with a red ball inside, from a place outside of the walls.
std::array<int, 3> middle_seen_from(const Vector3f& eye, const char* front_opacity) {
  const Scene scene = std::get<Scene>(parse_scene(
      std::string("[framework]\nhalf_width = 2\nheight = 2\nthickness = 0.2\nwall_colour = \"#2040FF\"\n"
                  "front_opacity = ") +
          front_opacity +
          "\n[[soft_body]]\nshape = { kind = \"sphere\", radius = 0.8 }\ncell_size = 0.4\nposition = [0, "
          "0.9, "
          "0]\ncolour = \"#FF2010\"\n[camera]\neye = [" +
          std::to_string(eye.x()) + ", " + std::to_string(eye.y()) + ", " + std::to_string(eye.z()) +
          "]\ntarget = [0, 0.9, 0]\n",
      "s.toml"));
  Simulation3d simulation(scene, {.spes = 2});
  const auto context = render::create_offscreen_context();
  render::Renderer renderer(*context, {.width = 64, .height = 64});
  const render::Image picture = SceneView(scene, simulation, renderer, View::kMesh).draw();
  const std::uint8_t* const pixel = picture.pixel(32, 32);
  return {pixel[0], pixel[1], pixel[2]};
}

TEST(SceneView3d, WallsBetweenTheCameraAndTheSceneAreGlass) {
  for (const Vector3f& eye : {Vector3f(0, 1, 7), Vector3f(7, 1, 0), Vector3f(-7, 1, 0), Vector3f(0, 1, -7)}) {
    const auto pixel = middle_seen_from(eye, "1");
    EXPECT_GT(pixel[0], pixel[2] + 40) << "from " << eye.transpose() << " the ball is seen";
  }
  const auto without = middle_seen_from({0, 1, 7}, "0");
  const auto glass = middle_seen_from({0, 1, 7}, "1");
  EXPECT_GT(glass[2], without[2] + 5) << "and the wall is, too";
}

}  // namespace
}  // namespace softcell::demos
