#include "softcell/render/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pinned_context.h"
#include "softcell/render/image_compare.h"
#include "test_scene.h"

namespace softcell::render {
namespace {

using test::pinned_context;

constexpr int kSide = 200;
const Colour kBackground = srgb(0x000000);

/// A camera 4 m above the origin that sees 4 m by 4 m of the ground: 50 pixels a metre, x to the right, z
/// downwards.
FrameDescription view_from_above() {
  FrameDescription frame;
  frame.camera.eye = {0, 4, 0};
  frame.camera.up = {0, 0, -1};
  frame.camera.tan_half_fov_y = 0.5f;
  frame.light.toward = {0.6f, 1, 0.4f};  // not straight above: the eye would look into its mirror image
  frame.light.shadow_radius = 4;
  frame.background_top = frame.background_bottom = kBackground;
  return frame;
}

const std::uint8_t* pixel_at(const Image& image, float x, float z) {
  return image.pixel(static_cast<int>(0.5f * kSide + 50 * x), static_cast<int>(0.5f * kSide + 50 * z));
}

int brightness(const std::uint8_t* pixel) { return pixel[0] + pixel[1] + pixel[2]; }

/// One triangle in the ground plane that faces up: the right angle at 0, legs of 1 m along x and z.
test::SkinnedMesh ground_triangle() {
  test::SkinnedMesh mesh;
  const Eigen::Vector3f up(0, 1, 0);
  mesh.add_vertex({0, 0, 0}, up);
  mesh.add_vertex({0, 0, 1}, up);
  mesh.add_vertex({1, 0, 0}, up);
  mesh.indices = {0, 1, 2};
  return mesh;
}

/// The pinned context, whose framebuffers may be made to fail for want of memory.
class FailingContext final : public GlContext {
 public:
  void make_current() override { pinned_context().make_current(); }
  Function function(const char* name) const override {
    const Function real = pinned_context().function(name);
    if (std::string_view(name) == "glCheckFramebufferStatus") {
      check_ = reinterpret_cast<Check*>(real);
      return reinterpret_cast<Function>(&check);
    }
    return std::string_view(name) == "glGetError" ? reinterpret_cast<Function>(&error) : real;
  }
  std::string backend_name() const override { return pinned_context().backend_name(); }

  static inline bool fails = false;

 private:
  using Check = unsigned int(unsigned int target);
  static unsigned int check(unsigned int target) {
    if (!fails) return check_(target);
    constexpr unsigned int kOutOfMemory = 0x0505;
    error_ = kOutOfMemory;
    return 0;
  }
  static unsigned int error() { return std::exchange(error_, 0u); }
  static inline Check* check_ = nullptr;
  static inline unsigned int error_ = 0;
};

class RendererTest : public testing::Test {
 protected:
  const Image& draw(const FrameDescription& frame) {
    renderer_.render(frame);
    return renderer_.pixels();
  }

  SkinnedDraw add(const test::SkinnedMesh& mesh) {
    SkinnedDraw item;
    item.mesh = renderer_.add_mesh(mesh.indices);
    renderer_.update_mesh(item.mesh, mesh.bytes());
    return item;
  }

  Renderer renderer_{pinned_context(), {.width = kSide, .height = kSide}};
};

TEST_F(RendererTest, DrawsHalfFloatTrianglesWhereTheyAre) {
  SkinnedDraw item = add(ground_triangle());
  item.origin = {0.5f, 0, -1};
  item.colour = srgb(0xFF0000);
  FrameDescription frame = view_from_above();
  frame.skinned = std::span(&item, 1);
  const Image& image = draw(frame);

  // Inside the triangle (0.5, -1) (0.5, 0) (1.5, -1), red; outside, the background.
  for (const auto& [x, z] : {std::pair(0.56f, -0.94f), {0.56f, -0.16f}, {1.34f, -0.94f}, {0.9f, -0.5f}}) {
    const std::uint8_t* const pixel = pixel_at(image, x, z);
    EXPECT_GT(pixel[0], 180) << x << ' ' << z;
    EXPECT_LT(pixel[1], 100) << x << ' ' << z;
    EXPECT_EQ(pixel[3], 255);
  }
  for (const auto& [x, z] : {std::pair(0.44f, -0.5f), {0.9f, -1.06f}, {1.06f, -0.44f}, {-1.0f, 1.0f}}) {
    EXPECT_LT(brightness(pixel_at(image, x, z)), 10) << x << ' ' << z;
  }
}

TEST_F(RendererTest, SmoothsEdgesWithFourSamples) {
  SkinnedDraw item = add(ground_triangle());
  FrameDescription frame = view_from_above();
  frame.skinned = std::span(&item, 1);
  const Image& image = draw(frame);
  // Along the hypotenuse pixels are covered in part: there are values between the background's and the
  // surface's.
  const int inside = brightness(pixel_at(image, 0.2f, 0.2f));
  int between = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const int value = brightness(image.pixel(i % kSide, i / kSide));
    between += value > inside / 8 && value < inside * 7 / 8;
  }
  EXPECT_GT(between, 20);
}

TEST_F(RendererTest, ShowsNewVerticesFromTheNextFrameOn) {
  test::SkinnedMesh mesh = ground_triangle();
  SkinnedDraw item = add(mesh);
  FrameDescription frame = view_from_above();
  frame.skinned = std::span(&item, 1);
  EXPECT_GT(brightness(pixel_at(draw(frame), 0.2f, 0.2f)), 300);

  test::SkinnedMesh moved;
  for (const Eigen::Vector3f& corner : {Eigen::Vector3f(-1.5f, 0, 0), {-1.5f, 0, 1}, {-0.5f, 0, 0}}) {
    moved.add_vertex(corner, {0, 1, 0});
  }
  renderer_.update_mesh(item.mesh, moved.bytes());
  const Image& image = draw(frame);
  EXPECT_LT(brightness(pixel_at(image, 0.2f, 0.2f)), 10);
  EXPECT_GT(brightness(pixel_at(image, -1.3f, 0.2f)), 300);
}

TEST_F(RendererTest, DrawsOnlyWhereThePictureChanges) {
  SkinnedDraw item = add(ground_triangle());
  FrameDescription frame = view_from_above();
  frame.light.occlusion = 0;                // it would reach over the edge of the part
  frame.changes = PixelRect{0, 0, 10, 10};  // there is no last frame: everything is drawn
  frame.skinned = std::span(&item, 1);
  const Image first = draw(frame);
  EXPECT_GT(brightness(pixel_at(first, 0.2f, 0.2f)), 300);

  item.origin = {-1, 0, -1};
  frame.changes.reset();
  const Image all = draw(frame);
  item.origin = {0, 0, 0};
  draw(frame);
  item.origin = {-1, 0, -1};
  const PixelRect part{.left = 60, .top = -5, .right = 110, .bottom = 120};
  frame.changes = part;
  const Image& image = draw(frame);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      // With several samples llvmpipe draws a pixel beyond the scissor's edge.
      if (std::abs(x - part.left) <= 1 || std::abs(x - part.right) <= 1 || std::abs(y - part.bottom) <= 1)
        continue;
      const bool inside = x > part.left && x < part.right && y < part.bottom;
      const std::uint8_t* const expected = (inside ? all : first).pixel(x, y);
      ASSERT_TRUE(std::equal(expected, expected + 4, image.pixel(x, y))) << x << ' ' << y;
    }
  }

  frame.changes = PixelRect{};  // nowhere
  item.origin = {9, 9, 9};
  const Image before = image;
  EXPECT_EQ(draw(frame), before);
  renderer_.resize(kSide / 2, kSide / 2);
  item.origin = {0, 0, 0};
  EXPECT_GT(brightness(draw(frame).pixel(kSide / 4 + 5, kSide / 4 + 5)), 300);
}

TEST(Renderer, AResizeThatFailsLeavesThePictureAsItWas) {
  FailingContext context;
  Renderer renderer(context, {.width = kSide, .height = kSide});
  FrameDescription frame = view_from_above();
  frame.background_top = srgb(0xFF0000);
  renderer.render(frame);
  const Image before = renderer.pixels();
  FailingContext::fails = true;
  EXPECT_THROW(renderer.resize(kSide / 2, kSide + 1), std::runtime_error);
  FailingContext::fails = false;
  EXPECT_EQ(renderer.width(), kSide);
  EXPECT_EQ(renderer.height(), kSide);
  EXPECT_EQ(renderer.pixels(), before);
  renderer.render(frame);
  EXPECT_EQ(renderer.pixels(), before);
  renderer.resize(kSide / 2, kSide / 2);  // of what was wrong before nothing is left
  EXPECT_EQ(renderer.width(), kSide / 2);
}

TEST_F(RendererTest, QuickShadowsFallWhereSoftOnesDo) {
  const StaticMeshId floor = test::add_unit_box(renderer_);
  Renderer quick(pinned_context(), {.width = kSide, .height = kSide, .soft_shadows = false});
  ASSERT_EQ(test::add_unit_box(quick).value, floor.value);
  const std::array<StaticDraw, 2> boxes{
      StaticDraw{
          .mesh = floor, .pose = test::box_pose({0, -0.05f, 0}, {4, 0.1f, 4}), .colour = srgb(0xFFFFFF)},
      StaticDraw{
          .mesh = floor, .pose = test::box_pose({0, 0.5f, 0}, {1, 0.1f, 1}), .colour = srgb(0xFFFFFF)}};
  FrameDescription frame = view_from_above();
  frame.statics = boxes;
  const Image& soft = draw(frame);
  quick.render(frame);
  const ImageDifference difference = compare(quick.pixels(), soft);
  EXPECT_GT(difference.over_2, 20u);  // the edges
  EXPECT_LT(difference.over_2, difference.pixels / 50);
}

TEST_F(RendererTest, HidesTheInnerSideUnlessAskedForBoth) {
  test::SkinnedMesh mesh = ground_triangle();
  std::swap(mesh.indices[0], mesh.indices[1]);
  SkinnedDraw item = add(mesh);
  FrameDescription frame = view_from_above();
  frame.skinned = std::span(&item, 1);
  EXPECT_LT(brightness(pixel_at(draw(frame), 0.2f, 0.2f)), 10);
  item.two_sided = true;
  EXPECT_GT(brightness(pixel_at(draw(frame), 0.2f, 0.2f)), 100);
}

TEST_F(RendererTest, ABoxDarkensTheFloorUnderItAndNothingElse) {
  const StaticMeshId box = test::add_unit_box(renderer_);
  StaticDraw floor;
  floor.mesh = box;
  floor.pose = test::box_pose({0, -0.5f, 0}, {20, 1, 20});
  // A box of 0.4 m hovers to the left of the middle; the light comes in at 45 degrees from the left, so that
  // its shadow falls 1 m further right: onto -0.2..0.2.
  StaticDraw crate;
  crate.mesh = box;
  crate.pose = test::box_pose({-1, 1, 0}, {0.4f, 0.4f, 0.4f});
  const std::array both{floor, crate};
  FrameDescription frame = view_from_above();
  frame.light.toward = {-1, 1, 0};
  frame.statics = std::span(both).first(1);
  const Image lit = draw(frame);
  frame.statics = both;
  const Image& shadowed = draw(frame);

  const int bright = brightness(pixel_at(lit, 0, 0));
  EXPECT_LT(brightness(pixel_at(shadowed, 0, 0)), bright * 85 / 100) << "of " << bright;
  EXPECT_LT(brightness(pixel_at(shadowed, 0.1f, 0.1f)), bright * 85 / 100);
  for (const auto& [x, z] :
       {std::pair(0.5f, 0.0f), {-0.5f, 0.0f}, {0.0f, 0.35f}, {0.0f, -0.35f}, {1.5f, 1.5f}}) {
    EXPECT_NEAR(brightness(pixel_at(shadowed, x, z)), brightness(pixel_at(lit, x, z)), 3) << x << ' ' << z;
  }
}

TEST_F(RendererTest, ASkinnedBodyCastsAShadowUnlessItIsTranslucent) {
  SkinnedDraw item = add(ground_triangle());
  item.origin = {-1.4f, 1, -0.3f};  // the light at 45 degrees moves its shadow to x = -0.4, z = -0.3
  StaticDraw floor;
  floor.mesh = test::add_unit_box(renderer_);
  floor.pose = test::box_pose({0, -0.5f, 0}, {20, 1, 20});
  FrameDescription frame = view_from_above();
  frame.light.toward = {-1, 1, 0};
  frame.statics = std::span(&floor, 1);
  const int bright = brightness(pixel_at(draw(frame), 0, 0));
  frame.skinned = std::span(&item, 1);
  EXPECT_LT(brightness(pixel_at(draw(frame), 0, 0)), bright * 85 / 100) << "of " << bright;
  item.opacity = 0.99f;
  EXPECT_EQ(brightness(pixel_at(draw(frame), 0, 0)), bright);
}

TEST_F(RendererTest, ALitFloorHasNoShadowAcne) {
  StaticDraw floor;
  floor.mesh = test::add_unit_box(renderer_);
  floor.pose = test::box_pose({0, -0.5f, 0}, {20, 1, 20});
  FrameDescription frame = view_from_above();
  frame.statics = std::span(&floor, 1);
  for (const float slope : {0.0f, 1.0f, 3.0f}) {
    frame.light.toward = {slope, 1, 0.3f * slope};
    frame.light.shadow_radius = 0.01f;  // the map covers next to nothing: no shadows at all
    const Image without = draw(frame);
    frame.light.shadow_radius = 6;
    EXPECT_EQ(draw(frame), without) << "slope " << slope;
  }
}

TEST_F(RendererTest, AFootprintTouchesItsShadow) {
  // A box on the floor, light from the left: the floor is dark right beside its right side (no gap:
  // "peter-panning").
  const StaticMeshId box = test::add_unit_box(renderer_);
  std::array<StaticDraw, 2> items;
  items[0].mesh = items[1].mesh = box;
  items[0].pose = test::box_pose({0, -0.5f, 0}, {20, 1, 20});
  items[1].pose = test::box_pose({0, 0.25f, 0}, {0.5f, 0.5f, 0.5f});
  FrameDescription frame = view_from_above();
  frame.light.toward = {-1, 1, 0};
  frame.statics = items;
  const Image& image = draw(frame);
  const int bright = brightness(pixel_at(image, 1.5f, 0));
  // The top of the box, 3.5 m from the eye, hides the floor up to 0.286 m.
  EXPECT_LT(brightness(pixel_at(image, 0.32f, 0)), bright * 85 / 100) << "of " << bright;
}

TEST_F(RendererTest, TranslucentWallsLetWhatIsBehindThemThrough) {
  SkinnedDraw item = add(ground_triangle());
  item.colour = srgb(0xFF0000);
  StaticDraw wall;
  wall.mesh = test::add_unit_box(renderer_);
  wall.pose = test::box_pose({0, 1, 0}, {4, 0.1f, 4});
  wall.colour = srgb(0x0000FF);
  wall.opacity = 0.3f;
  FrameDescription frame = view_from_above();
  frame.skinned = std::span(&item, 1);
  frame.statics = std::span(&wall, 1);
  const Image& image = draw(frame);
  EXPECT_GT(pixel_at(image, 0.2f, 0.2f)[0], 120) << "the triangle";
  EXPECT_GT(pixel_at(image, 0.2f, 0.2f)[2], 40) << "the wall";
}

TEST_F(RendererTest, DrawsParticlesAsDiscsOfTheirRadiusAndLinksBetweenThem) {
  const std::array<Eigen::Vector3f, 2> particles{Eigen::Vector3f(-1, 0, 0), Eigen::Vector3f(1, 0, 0)};
  const std::array<std::array<std::uint32_t, 2>, 1> links{{{0, 1}}};
  LatticeDraw lattice;
  lattice.particles = particles;
  lattice.links = links;
  lattice.radius = 0.2f;
  FrameDescription frame = view_from_above();
  frame.lattices = std::span(&lattice, 1);
  const Image& image = draw(frame);
  EXPECT_GT(brightness(pixel_at(image, 1, 0)), 100);
  EXPECT_GT(brightness(pixel_at(image, 1.16f, 0)), 50) << "inside the disc";
  EXPECT_LT(brightness(pixel_at(image, 1.25f, 0)), 10) << "outside";
  EXPECT_LT(brightness(pixel_at(image, 1.17f, 0.17f)), 10) << "a disc has no corners";
  EXPECT_GT(brightness(image.pixel(kSide / 2, kSide / 2)) + brightness(image.pixel(kSide / 2, kSide / 2 - 1)),
            100)
      << "the link";
}

/// Red at the lower left, green at the lower right, blue above.
Image three_colours() {
  Image picture(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      std::uint8_t* const pixel = picture.pixel(x, y);
      pixel[y < 32 ? 2 : x < 32 ? 0 : 1] = 255;  // rows count from the top
      pixel[3] = 255;
    }
  }
  return picture;
}

TEST_F(RendererTest, ATextureLiesOnItsMeshTheRightWayUp) {
  SkinnedDraw item = add(ground_triangle());
  const std::vector<Eigen::Vector2f> coordinates{{0, 0}, {0, 1}, {1, 0}};
  renderer_.set_texture_coordinates(item.mesh, coordinates);
  item.texture = renderer_.add_texture(three_colours());
  item.colour = {1, 1, 1};
  FrameDescription frame = view_from_above();
  frame.skinned = std::span(&item, 1);
  const Image& image = draw(frame);
  const auto strongest = [&](float x, float z) {
    const std::uint8_t* const pixel = pixel_at(image, x, z);
    return std::max_element(pixel, pixel + 3) - pixel;
  };
  EXPECT_EQ(strongest(0.1f, 0.1f), 0);
  EXPECT_EQ(strongest(0.8f, 0.1f), 1);
  EXPECT_EQ(strongest(0.1f, 0.8f), 2);
  EXPECT_GT(pixel_at(image, 0.1f, 0.1f)[0], 180);
  EXPECT_LT(pixel_at(image, 0.1f, 0.1f)[1], 100);

  // Without it the mesh is drawn as before; its colour is multiplied with the texture's.
  const std::optional<TextureId> texture = std::exchange(item.texture, std::nullopt);
  EXPECT_GT(pixel_at(draw(frame), 0.8f, 0.1f)[0], 180);
  item.texture = texture;
  item.colour = {0, 1, 0};
  EXPECT_LT(pixel_at(draw(frame), 0.1f, 0.1f)[0], 130);
}

TEST_F(RendererTest, RefusesTexturesThatDoNotFit) {
  SkinnedDraw item = add(ground_triangle());
  const std::vector<Eigen::Vector2f> two(2, Eigen::Vector2f(0, 0));
  EXPECT_THROW(renderer_.set_texture_coordinates(item.mesh, two), std::invalid_argument);
  EXPECT_THROW(renderer_.set_texture_coordinates(MeshId{99}, two), std::invalid_argument);
  EXPECT_THROW(renderer_.add_texture(Image()), std::invalid_argument);
  FrameDescription frame = view_from_above();
  frame.skinned = std::span(&item, 1);
  item.texture = TextureId{0};
  EXPECT_THROW(renderer_.render(frame), std::invalid_argument);  // no such texture
  item.texture = renderer_.add_texture(three_colours());
  EXPECT_THROW(renderer_.render(frame), std::invalid_argument);  // no coordinates
}

void expect_refusal(const std::function<void()>& call, const char* sentence) {
  try {
    call();
    ADD_FAILURE() << "accepted; expected: " << sentence;
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), sentence);
  }
}

/// A game adds and removes textures and meshes with each level.
TEST_F(RendererTest, HandlesOfWhatWasRemovedAreRefusedAlsoWhenTheirSlotsAreFilledAgain) {
  SkinnedDraw item = add(ground_triangle());
  const std::vector<Eigen::Vector2f> coordinates{{0, 0}, {0, 1}, {1, 0}};
  renderer_.set_texture_coordinates(item.mesh, coordinates);
  item.colour = {1, 1, 1};
  item.texture = renderer_.add_texture(three_colours());
  FrameDescription frame = view_from_above();
  frame.skinned = std::span(&item, 1);
  const Image first = draw(frame);
  renderer_.remove_texture(*item.texture);
  EXPECT_THROW(renderer_.render(frame), std::invalid_argument);
  EXPECT_THROW(renderer_.remove_texture(*item.texture), std::invalid_argument);
  Image white(8, 8);
  std::ranges::fill(white.rgba, std::uint8_t{255});
  const TextureId next = renderer_.add_texture(white);
  EXPECT_EQ(next.value, item.texture->value) << "the renderer does not grow";
  expect_refusal([&] { renderer_.render(frame); }, "the texture 0 was removed");
  expect_refusal([&] { renderer_.remove_texture(*item.texture); }, "the texture 0 was removed");
  item.texture = next;
  EXPECT_NE(draw(frame), first) << "it shows the new picture";
  item.texture = renderer_.add_texture(three_colours());
  EXPECT_NE(item.texture->value, next.value);
  EXPECT_EQ(draw(frame), first);

  const MeshId removed = item.mesh;
  renderer_.remove_mesh(removed);
  item.mesh = add(ground_triangle()).mesh;
  EXPECT_EQ(item.mesh.value, removed.value);
  renderer_.set_texture_coordinates(item.mesh, coordinates);
  EXPECT_EQ(draw(frame), first);
  expect_refusal([&] { renderer_.set_texture_coordinates(removed, coordinates); }, "the mesh 0 was removed");
  expect_refusal([&] { renderer_.remove_mesh(removed); }, "the mesh 0 was removed");
  item.mesh = removed;
  expect_refusal([&] { renderer_.render(frame); }, "the mesh 0 was removed");
  item.mesh = {};
  expect_refusal([&] { renderer_.render(frame); }, "no mesh 0");

  StaticDraw box{.mesh = test::add_unit_box(renderer_)};
  frame.skinned = {};
  frame.statics = std::span(&box, 1);
  const Image with_box = draw(frame);
  renderer_.remove_static_mesh(box.mesh);
  EXPECT_THROW(renderer_.render(frame), std::invalid_argument);
  EXPECT_THROW(renderer_.remove_static_mesh(box.mesh), std::invalid_argument);
  const StaticMeshId other_box = test::add_unit_box(renderer_);
  EXPECT_EQ(other_box.value, box.mesh.value);
  expect_refusal([&] { renderer_.render(frame); }, "the static mesh 0 was removed");
  box.mesh = other_box;
  EXPECT_EQ(draw(frame), with_box);
}

TEST_F(RendererTest, DrawsTheSameFrameInTheSameBits) {
  const test::TestScene scene(renderer_, 1);
  const Image first = draw(scene.frame());
  EXPECT_EQ(draw(scene.frame()), first);
  Renderer other(pinned_context(), {.width = kSide, .height = kSide});
  const test::TestScene same(other, 1);
  other.render(same.frame());
  EXPECT_EQ(other.pixels(), first);
}

TEST_F(RendererTest, PutsTheTopRowFirstAndHazeOnTheHorizon) {
  FrameDescription frame = view_from_above();
  frame.camera = {.eye = {0, 1, 0}, .target = {0, 1, -1}, .tan_half_fov_y = 3};
  frame.background_top = srgb(0xFFFFFF);
  const Image& image = draw(frame);
  EXPECT_GT(image.pixel(0, 0)[0], 240);
  EXPECT_LT(image.pixel(kSide / 2, kSide / 2)[0], 60);
  EXPECT_LT(image.pixel(0, kSide - 1)[0], image.pixel(0, 0)[0] - 20);
  frame.camera.up = {1, 0, 0};  // the horizon stands upright
  draw(frame);
  EXPECT_GT(image.pixel(kSide / 2, 0)[0], 230);
  EXPECT_LT(image.pixel(kSide / 2, kSide / 2)[0], 60);
}

/// Rises from the floor at 60 degrees, from x = -0.5 towards -x.
Eigen::Matrix4f steep_slope() {
  Eigen::Matrix4f pose = test::box_pose({-1.366f, -0.5f, 0}, {2, 2, 20});
  pose.topLeftCorner<2, 2>() << 1.732f, -1, 1, 1.732f;
  return pose;
}

TEST_F(RendererTest, NothingOccludesWhereNothingIsNear) {
  // A floor alone, and a slope across it: along the crease, and nowhere else, it is darker.
  std::array<StaticDraw, 2> items;
  items[0].mesh = items[1].mesh = test::add_unit_box(renderer_);
  items[0].pose = test::box_pose({0, -0.5f, 0}, {20, 1, 20});
  items[1].pose = steep_slope();
  FrameDescription frame = view_from_above();
  frame.light.toward = {1, 1, 0};
  frame.light.shadow_radius = 4;  // occlusion reaches 0.24 m
  for (const std::size_t drawn : {std::size_t{1}, std::size_t{2}}) {
    frame.statics = std::span(items).first(drawn);
    frame.light.occlusion = 0;
    const Image without = draw(frame);
    frame.light.occlusion = 1;
    const Image& with = draw(frame);
    for (const float z : {-1.0f, 0.0f, 1.0f}) {
      for (const float x : {0.0f, 0.5f, 1.0f, -1.2f})
        EXPECT_NEAR(brightness(pixel_at(with, x, z)), brightness(pixel_at(without, x, z)), 3)
            << x << ' ' << z;
      const int bright = brightness(pixel_at(without, -0.46f, z)),
                dark = brightness(pixel_at(with, -0.46f, z));
      if (drawn == 1) {
        EXPECT_NEAR(dark, bright, 3);
      } else {
        EXPECT_LT(dark, bright * 94 / 100) << z;
        EXPECT_GT(dark, bright * 40 / 100) << z;
      }
    }
  }
}

TEST_F(RendererTest, OcclusionIsSmoothAndStaysWhereItIsWhenTheCameraMoves) {
  std::array<StaticDraw, 2> items;
  items[0].mesh = items[1].mesh = test::add_unit_box(renderer_);
  items[0].pose = test::box_pose({0, -0.5f, 0}, {20, 1, 20});
  items[1].pose = steep_slope();
  FrameDescription frame = view_from_above();
  frame.light.toward = {1, 1, 0};
  frame.light.shadow_radius = 4;
  frame.statics = items;
  int least = 1000, most = 0;
  for (int shift = 0; shift < 4; ++shift) {
    // By less than a pixel along the crease: what is seen is the same.
    const Eigen::Vector3f moved(0, 0, 0.003f * static_cast<float>(shift));
    frame.camera.eye = Eigen::Vector3f(0, 4, 0) + moved;
    frame.camera.target = moved;
    const Image& image = draw(frame);
    for (int y = 20; y < kSide - 20; ++y) {
      const int value = brightness(image.pixel(kSide / 2 - 23, y));  // x = -0.46
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
  EXPECT_LT(most - least, most / 20) << least << " to " << most;
}

TEST_F(RendererTest, SmoothsEdgesOfASingleSample) {
  for (const int occlusion_pixels : {0, 4}) {
    Renderer single(pinned_context(),
                    {.width = kSide, .height = kSide, .samples = 1, .occlusion_pixels = occlusion_pixels});
    const test::SkinnedMesh mesh = ground_triangle();
    SkinnedDraw item;
    item.mesh = single.add_mesh(mesh.indices);
    single.update_mesh(item.mesh, mesh.bytes());
    FrameDescription frame = view_from_above();
    frame.skinned = std::span(&item, 1);
    single.render(frame);
    const Image& image = single.pixels();
    const int inside = brightness(pixel_at(image, 0.2f, 0.2f));
    EXPECT_GT(inside, 300);
    int between = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
      const int value = brightness(image.pixel(i % kSide, i / kSide));
      between += value > inside / 8 && value < inside * 7 / 8;
    }
    EXPECT_GT(between, 20) << "along the hypotenuse, occlusion " << occlusion_pixels;
    EXPECT_LT(between, 6 * kSide) << "and nowhere else";
  }
}

TEST_F(RendererTest, APictureHasNoHoles) {
  StaticDraw wall;
  wall.mesh = test::add_unit_box(renderer_);
  wall.opacity = 0.3f;
  FrameDescription frame = view_from_above();
  frame.statics = std::span(&wall, 1);
  Renderer single(pinned_context(), {.width = kSide, .height = kSide, .samples = 1});
  test::add_unit_box(single);
  single.render(frame);
  for (const Image* const image : {&draw(frame), &single.pixels()}) {
    for (int i = 0; i < kSide * kSide; ++i) ASSERT_EQ(image->pixel(i % kSide, i / kSide)[3], 255) << i;
  }
}

/// A mesh of half floats as floats.
std::pair<std::vector<Eigen::Vector3f>, std::vector<Eigen::Vector3f>> shape_of(
    const test::SkinnedMesh& mesh) {
  std::pair<std::vector<Eigen::Vector3f>, std::vector<Eigen::Vector3f>> shape;
  for (std::size_t v = 0; v < mesh.vertices.size(); v += 8) {
    const auto at = [&](std::size_t i) {
      return static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(mesh.vertices[v + i]));
    };
    shape.first.emplace_back(at(0), at(1), at(2));
    shape.second.emplace_back(at(4), at(5), at(6));
  }
  return shape;
}

TEST_F(RendererTest, FewerTrianglesOfASmallMeshLookTheSameAndALargeOneHasThemAll) {
  const test::SkinnedMesh torus = test::make_torus(160, 80);
  const auto shape = shape_of(torus);
  Renderer coarse(pinned_context(), {.width = kSide, .height = kSide, .coarse_pixels = 12});
  const auto add_to = [&](Renderer& renderer, bool with_box) {
    SkinnedDraw item;
    item.mesh = renderer.add_mesh(torus.indices);
    item.colour = srgb(0xC05020);
    renderer.update_mesh(item.mesh, torus.bytes());
    renderer.set_rest_shape(item.mesh, shape.first, shape.second);
    if (with_box)
      item.box.emplace(Eigen::Vector3f(-0.85f, -0.25f, -0.85f), Eigen::Vector3f(0.85f, 0.25f, 0.85f));
    return item;
  };
  const auto pictures = [&](float height, bool with_box) {
    FrameDescription frame = view_from_above();
    frame.camera.eye.y() = height;
    const SkinnedDraw exact = add_to(renderer_, true), fewer = add_to(coarse, with_box);
    frame.skinned = std::span(&exact, 1);
    const Image expected = draw(frame);
    frame.skinned = std::span(&fewer, 1);
    coarse.render(frame);
    return compare(coarse.pixels(), expected);
  };
  const ImageDifference far = pictures(5, true);
  EXPECT_GT(far.over_0, 100u) << "it has as many triangles as ever";
  EXPECT_LT(far.rmse, 2) << describe(far);
  EXPECT_LT(far.over_8, 300u) << describe(far);  // of some 4,000 that show it
  const ImageDifference near = pictures(0.45f, true);
  EXPECT_EQ(near.over_8, 0u) << describe(near);  // only the shadow has fewer triangles
  EXPECT_EQ(pictures(5, false).over_8, 0u) << "nobody has said where it is";
}

TEST_F(RendererTest, RefusesRestShapesThatDoNotFit) {
  const test::SkinnedMesh torus = test::make_torus(8, 6);
  const auto [positions, normals] = shape_of(torus);
  const MeshId id = renderer_.add_mesh(torus.indices);
  EXPECT_THROW(renderer_.set_rest_shape(id, std::span(positions).first(47), std::span(normals).first(47)),
               std::invalid_argument);
  EXPECT_THROW(renderer_.set_rest_shape(id, positions, std::span(normals).first(47)), std::invalid_argument);
  EXPECT_THROW(renderer_.set_rest_shape({77}, positions, normals), std::invalid_argument);
}

TEST_F(RendererTest, RefusesWhatWouldReadPastItsBuffers) {
  const test::SkinnedMesh mesh = ground_triangle();
  const MeshId id = renderer_.add_mesh(mesh.indices);
  EXPECT_THROW(renderer_.update_mesh(id, mesh.bytes().first(2 * kSkinnedVertexBytes)), std::invalid_argument);
  EXPECT_THROW(renderer_.update_mesh(id, mesh.bytes().first(3 * kSkinnedVertexBytes - 8)),
               std::invalid_argument);
  EXPECT_THROW(renderer_.update_mesh({77}, mesh.bytes()), std::invalid_argument);
  EXPECT_THROW(renderer_.add_mesh(std::span(mesh.indices).first(2)), std::invalid_argument);

  const std::array<Eigen::Vector3f, 3> points{Eigen::Vector3f(0, 0, 0), {1, 0, 0}, {0, 1, 0}};
  const std::array<Triangle, 1> good{{{0, 1, 2}}};
  const std::array<Triangle, 1> bad{{{0, 1, 3}}};
  EXPECT_THROW(renderer_.add_static_mesh(points, points, bad), std::invalid_argument);
  EXPECT_THROW(renderer_.add_static_mesh(points, std::span(points).first(2), good), std::invalid_argument);

  const std::array<std::array<std::uint32_t, 2>, 1> links{{{0, 3}}};
  LatticeDraw lattice;
  lattice.particles = points;
  lattice.links = links;
  FrameDescription frame = view_from_above();
  frame.lattices = std::span(&lattice, 1);
  EXPECT_THROW(renderer_.render(frame), std::invalid_argument);
  const StaticDraw nothing{.mesh = {5}};
  frame = view_from_above();
  frame.statics = std::span(&nothing, 1);
  EXPECT_THROW(renderer_.render(frame), std::invalid_argument);
}

TEST(RendererSettings, RefusesSizesThatCannotBeDrawn) {
  EXPECT_THROW(Renderer(pinned_context(), {.width = 0, .height = 10}), std::runtime_error);
  EXPECT_THROW(Renderer(pinned_context(), {.width = 10, .height = 1 << 24}), std::runtime_error);
  EXPECT_THROW(Renderer(pinned_context(), {.width = 16384, .height = 16384}), std::runtime_error);
  const auto get_error = reinterpret_cast<GLenum (*)()>(pinned_context().function("glGetError"));
  EXPECT_EQ(get_error(), 0u) << "what was refused is an error of the context";
}

TEST(RendererSettings, AreNotRefusedForAnErrorThatWasThereBefore) {
  pinned_context().make_current();
  reinterpret_cast<void (*)(GLenum)>(pinned_context().function("glEnable"))(0xFFFF);
  EXPECT_NO_THROW(Renderer(pinned_context(), {.width = 16, .height = 16}));
}

TEST(Srgb, IsNearTheCurve) {
  EXPECT_EQ(srgb(0x000000), Colour(0, 0, 0));
  for (std::uint32_t level = 0; level < 256; ++level) {
    const double encoded = level / 255.0;
    const double exact = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(srgb(level << 8).y(), exact, 0.003) << level;
  }
}

}  // namespace
}  // namespace softcell::render
