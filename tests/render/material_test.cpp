// Parts of meshes with materials of their own.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "pinned_context.h"
#include "softcell/render/renderer.h"
#include "test_scene.h"

namespace softcell::render {
namespace {

using test::pinned_context;

constexpr int kPixels = 128;

/// A camera above the origin that sees 2 m by 2 m of the ground, x to the right, z downwards, in even light from above
/// and sun from the side of +x.
FrameDescription from_above() {
  FrameDescription frame;
  frame.camera.eye = {0, 4, 0};
  frame.camera.up = {0, 0, -1};
  frame.camera.tan_half_fov_y = 0.25f;
  frame.light.toward = {1, 1, 0};
  frame.light.shadow_radius = 4;
  frame.background_top = frame.background_bottom = srgb(0x000000);
  return frame;
}

/// A square from -1 to 1 on the ground, of a triangle to the lower left and one to the upper right, turned about y.
test::SkinnedMesh ground_square(float cosine = 1, float sine = 0) {
  test::SkinnedMesh mesh;
  for (const auto& [x, z] :
       {std::array{-1.0f, 1.0f}, std::array{1.0f, 1.0f}, std::array{1.0f, -1.0f}, std::array{-1.0f, -1.0f}})
    mesh.add_vertex({cosine * x + sine * z, 0, cosine * z - sine * x}, {0, 1, 0});
  mesh.indices = {0, 1, 3, 1, 2, 3};
  return mesh;
}
const std::vector<Eigen::Vector2f> kCoordinates{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

Image plain_picture(std::array<std::uint8_t, 4> colour) {
  Image picture(4, 4);
  for (std::size_t i = 0; i < picture.rgba.size(); ++i) picture.rgba[i] = colour[i % 4];
  return picture;
}

class MaterialTest : public testing::Test {
 protected:
  /// The square drawn in parts.
  const Image& draw(std::span<const PartDraw> parts, const test::SkinnedMesh& mesh = ground_square(),
                    float opacity = 1) {
    SkinnedDraw item;
    item.mesh = renderer_.add_mesh(mesh.indices);
    renderer_.update_mesh(item.mesh, mesh.bytes());
    if (coordinates_) renderer_.set_texture_coordinates(item.mesh, kCoordinates);
    if (!colours_.empty()) renderer_.set_vertex_colours(item.mesh, colours_);
    item.parts = parts;
    item.opacity = opacity;
    FrameDescription frame = from_above();
    frame.skinned = std::span(&item, 1);
    renderer_.render(frame);
    return renderer_.pixels();
  }
  const Image& draw(const Material& material, const test::SkinnedMesh& mesh = ground_square(),
                    float opacity = 1) {
    const PartDraw whole{0, 2, material};
    return draw(std::span(&whole, 1), mesh, opacity);
  }
  static int sum(const Image& image, int x = kPixels / 2 + 7, int y = kPixels / 2 - 3) {
    const std::uint8_t* const pixel = image.pixel(x, y);
    return pixel[0] + pixel[1] + pixel[2];
  }

  Renderer renderer_{pinned_context(), {.width = kPixels, .height = kPixels}};
  bool coordinates_ = true;
  std::vector<Eigen::Vector4f> colours_;
};

TEST_F(MaterialTest, EachPartHasItsColour) {
  const std::array<PartDraw, 2> parts{PartDraw{0, 1, {.base_colour = {1, 0, 0}}},
                                      PartDraw{1, 1, {.base_colour = {0, 1, 0}}}};
  const Image& image = draw(parts);
  const std::uint8_t* const lower_left = image.pixel(20, kPixels - 20);
  const std::uint8_t* const upper_right = image.pixel(kPixels - 20, 20);
  EXPECT_GT(lower_left[0], 2 * lower_left[1]);
  EXPECT_GT(upper_right[1], 2 * upper_right[0]);
  // A triangle of no part is not drawn.
  EXPECT_EQ(sum(draw(std::span(parts).first(1)), kPixels - 20, 20), 0);
}

TEST_F(MaterialTest, ColoursOfVerticesAreMultiplied) {
  colours_ = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}};
  const std::uint8_t* pixel = draw(Material{.vertex_colours = true}).pixel(64, 64);
  EXPECT_GT(pixel[0], 2 * pixel[1]);
  pixel = draw(Material{.base_colour = {0, 1, 1}, .vertex_colours = true}).pixel(64, 64);
  EXPECT_LT(pixel[0], 100) << "red times cyan is black, but for what the surface mirrors";
  pixel = draw(Material{}).pixel(64, 64);
  EXPECT_EQ(pixel[0] > 150 && pixel[1] > 150, true) << "they are not used unless asked for";
}

TEST_F(MaterialTest, AMaskCutsAndItsAlphaIsOfAllFactors) {
  const TextureId half = renderer_.add_texture(plain_picture({255, 255, 255, 128}));
  EXPECT_GT(sum(draw(Material{.base_texture = half})), 300) << "alpha is not used";
  EXPECT_GT(sum(draw(Material{.base_texture = half, .alpha_mode = AlphaMode::kMask, .alpha_cutoff = 0.4f})),
            300);
  EXPECT_EQ(sum(draw(Material{.base_texture = half, .alpha_mode = AlphaMode::kMask, .alpha_cutoff = 0.6f})),
            0);
  EXPECT_EQ(sum(draw(Material{
                .alpha = 0.5f, .base_texture = half, .alpha_mode = AlphaMode::kMask, .alpha_cutoff = 0.4f})),
            0);
  const int blended = sum(draw(Material{.base_texture = half, .alpha_mode = AlphaMode::kBlend}));
  EXPECT_GT(blended, 150);
  EXPECT_LT(blended, sum(draw(Material{.base_texture = half})) - 50);
}

TEST_F(MaterialTest, AFlatNormalMapChangesNothing) {
  const Image without = draw(Material{});
  const TextureId flat = renderer_.add_texture(plain_picture({128, 128, 255, 255}), {.linear = true});
  const Image& with = draw(Material{.normal_texture = flat});
  for (std::size_t i = 0; i < with.rgba.size(); ++i) ASSERT_NEAR(with.rgba[i], without.rgba[i], 1) << i;
}

TEST_F(MaterialTest, ANormalMapTiltsTheSurfaceAlongItsTexture) {
  const Colour kGrey{0.3f, 0.3f, 0.3f};  // far from white, where tones are bent
  // Towards larger u, which is +x, where the sun is.
  const TextureId along_u = renderer_.add_texture(plain_picture({218, 128, 218, 255}), {.linear = true});
  const TextureId against_u = renderer_.add_texture(plain_picture({38, 128, 218, 255}), {.linear = true});
  const TextureId along_v = renderer_.add_texture(plain_picture({128, 218, 218, 255}), {.linear = true});
  const int flat = sum(draw(Material{.base_colour = kGrey, .roughness = 1}));
  EXPECT_GT(sum(draw(Material{.base_colour = kGrey, .roughness = 1, .normal_texture = along_u})), flat + 20);
  EXPECT_LT(sum(draw(Material{.base_colour = kGrey, .roughness = 1, .normal_texture = against_u})),
            flat - 100);
  EXPECT_LT(
      std::abs(sum(draw(Material{
                   .base_colour = kGrey, .roughness = 1, .normal_texture = along_u, .normal_scale = 0})) -
               flat),
      4);
  EXPECT_LT(
      std::abs(sum(draw(Material{
                   .base_colour = kGrey, .roughness = 1, .normal_texture = along_u, .normal_scale = -1})) -
               sum(draw(Material{.base_colour = kGrey, .roughness = 1, .normal_texture = against_u}))),
      8);
  // The directions turn with the mesh: by a quarter about y, u grows along -z and v along -x, away from the sun.
  EXPECT_LT(sum(draw(Material{.base_colour = kGrey, .roughness = 1, .normal_texture = along_v},
                     ground_square(0, 1))),
            flat - 100);
  EXPECT_GT(sum(draw(Material{.base_colour = kGrey, .roughness = 1, .normal_texture = along_v},
                     ground_square(0, -1))),
            flat + 20);
}

TEST_F(MaterialTest, ASurfaceThatCannotBeMappedKeepsItsNormal) {
  coordinates_ = false;
  SkinnedDraw item;
  const test::SkinnedMesh mesh = ground_square();
  item.mesh = renderer_.add_mesh(mesh.indices);
  renderer_.update_mesh(item.mesh, mesh.bytes());
  renderer_.set_texture_coordinates(item.mesh, std::vector<Eigen::Vector2f>(4, {0.5f, 0.5f}));
  const TextureId along_u = renderer_.add_texture(plain_picture({218, 128, 218, 255}), {.linear = true});
  const PartDraw part{0, 2, {.normal_texture = along_u}};
  item.parts = std::span(&part, 1);
  FrameDescription frame = from_above();
  frame.skinned = std::span(&item, 1);
  renderer_.render(frame);
  const Image with = renderer_.pixels();
  EXPECT_LT(std::abs(sum(with) - sum(draw(Material{}))), 4);
}

TEST_F(MaterialTest, MetalHasNoMatteColourAndRoughnessSpreadsTheHighlight) {
  // Seen from above, the sun at 45 degrees is not mirrored: polished metal is dark there but for the sky.
  const int matte = sum(draw(Material{.base_colour = {0.9f, 0.9f, 0.9f}, .metallic = 0, .roughness = 1}));
  const int polished =
      sum(draw(Material{.base_colour = {0.9f, 0.9f, 0.9f}, .metallic = 1, .roughness = 0.1f}));
  const int brushed =
      sum(draw(Material{.base_colour = {0.9f, 0.9f, 0.9f}, .metallic = 1, .roughness = 0.6f}));
  EXPECT_LT(polished, matte - 200);
  EXPECT_GT(brushed, polished + 50);
  const TextureId rough_metal = renderer_.add_texture(plain_picture({0, 153, 255, 255}), {.linear = true});
  const int mapped = sum(draw(Material{.base_colour = {0.9f, 0.9f, 0.9f},
                                       .metallic = 1,
                                       .roughness = 1,
                                       .metallic_roughness_texture = rough_metal}));
  EXPECT_LT(std::abs(mapped - brushed), 4) << "green is roughness, 0.6; blue is metallic";
}

TEST_F(MaterialTest, EmissionIsAddedToTheLight) {
  const Material black{.base_colour = {0, 0, 0}, .roughness = 1};
  Material glowing = black;
  glowing.emission = {0, 0.5f, 0};
  const int dark = draw(black).pixel(64, 64)[1];
  EXPECT_GT(draw(glowing).pixel(64, 64)[1], dark + 80);
  glowing.emission_texture = renderer_.add_texture(plain_picture({255, 0, 255, 255}));
  EXPECT_EQ(draw(glowing).pixel(64, 64)[1], dark);
}

TEST_F(MaterialTest, ATwoSidedPartIsSeenFromInside) {
  test::SkinnedMesh inside_out = ground_square();
  inside_out.indices = {0, 3, 1, 1, 3, 2};
  EXPECT_EQ(sum(draw(Material{}, inside_out)), 0);
  EXPECT_GT(sum(draw(Material{.two_sided = true}, inside_out)), 300);
}

TEST_F(MaterialTest, OpacityBlendsAllParts) {
  const int opaque = sum(draw(Material{}));
  const int half = sum(draw(Material{}, ground_square(), 0.5f));
  EXPECT_LT(std::abs(half - opaque / 2), 12) << "over black";
}

TEST_F(MaterialTest, LinearTexturesAreNotDecodedAndClampedOnesEnd) {
  const TextureId encoded = renderer_.add_texture(plain_picture({128, 128, 128, 255}));
  const TextureId linear = renderer_.add_texture(plain_picture({128, 128, 128, 255}), {.linear = true});
  EXPECT_GT(sum(draw(Material{.base_texture = linear})), sum(draw(Material{.base_texture = encoded})) + 60);

  Image two(2, 1);
  two.rgba = {255, 0, 0, 255, 0, 0, 255, 255};
  const auto beyond = [&](Wrap wrap) {  // u from 1 to 2 over the square
    SkinnedDraw item;
    const test::SkinnedMesh mesh = ground_square();
    item.mesh = renderer_.add_mesh(mesh.indices);
    renderer_.update_mesh(item.mesh, mesh.bytes());
    renderer_.set_texture_coordinates(item.mesh,
                                      std::vector<Eigen::Vector2f>{{1, 0}, {2, 0}, {2, 1}, {1, 1}});
    const PartDraw part{0, 2, {.base_texture = renderer_.add_texture(two, {.wrap_u = wrap, .wrap_v = wrap})}};
    item.parts = std::span(&part, 1);
    FrameDescription frame = from_above();
    frame.skinned = std::span(&item, 1);
    renderer_.render(frame);
    const std::uint8_t* const pixel = renderer_.pixels().pixel(kPixels / 4, kPixels / 2);
    return pixel[0] > pixel[2] ? 'r' : 'b';
  };
  EXPECT_EQ(beyond(Wrap::kRepeat), 'r');
  EXPECT_EQ(beyond(Wrap::kMirror), 'b');
  EXPECT_EQ(beyond(Wrap::kClamp), 'b');
}

TEST_F(MaterialTest, StaticMeshesHavePartsToo) {
  const std::vector<Eigen::Vector3f> positions{{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
  const std::vector<Eigen::Vector3f> normals(4, Eigen::Vector3f(0, 1, 0));
  const std::vector<Triangle> triangles{{0, 1, 3}, {1, 2, 3}};
  StaticDraw item;
  item.mesh = renderer_.add_static_mesh(positions, normals, triangles);
  renderer_.set_texture_coordinates(item.mesh, kCoordinates);
  renderer_.set_vertex_colours(item.mesh, std::vector<Eigen::Vector4f>(4, {1, 1, 1, 1}));
  const PartDraw part{
      0, 2, {.base_texture = renderer_.add_texture(plain_picture({255, 0, 0, 255})), .vertex_colours = true}};
  item.parts = std::span(&part, 1);
  FrameDescription frame = from_above();
  frame.statics = std::span(&item, 1);
  renderer_.render(frame);
  const std::uint8_t* const pixel = renderer_.pixels().pixel(kPixels / 2, kPixels / 2);
  EXPECT_GT(pixel[0], 2 * pixel[1]);
}

TEST_F(MaterialTest, RefusesPartsThatDoNotFit) {
  const PartDraw beyond{1, 2, {}};
  EXPECT_THROW(draw(std::span(&beyond, 1)), std::invalid_argument);
  EXPECT_THROW(draw(Material{.base_texture = TextureId{7}}), std::invalid_argument);
  EXPECT_THROW(draw(Material{.vertex_colours = true}), std::invalid_argument);
  coordinates_ = false;
  const TextureId texture = renderer_.add_texture(plain_picture({255, 0, 0, 255}));
  EXPECT_THROW(draw(Material{.normal_texture = texture}), std::invalid_argument);
  EXPECT_THROW(renderer_.set_vertex_colours(MeshId{99}, colours_), std::invalid_argument);
  EXPECT_THROW(renderer_.set_vertex_colours(StaticMeshId{99}, colours_), std::invalid_argument);
}

}  // namespace
}  // namespace softcell::render
