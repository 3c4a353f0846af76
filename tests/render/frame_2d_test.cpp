// Frames in two dimensions.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <vector>

#include "pinned_context.h"
#include "softcell/render/renderer.h"

namespace softcell::render {
namespace {

using Eigen::Vector2f;
using test::pinned_context;

constexpr int kSideOf2d = 200;
const Colour kRed = srgb(0xFF0000);

/// 4 m by 4 m: 50 pixels a metre. Plain white paper without shadows.
Frame2d white_paper() {
  Frame2d frame;
  frame.height = 4;
  frame.paper = {.colour = srgb(0xFFFFFF), .line_colour = srgb(0xFFFFFF), .squares = 1};
  frame.shadow.strength = 0;
  return frame;
}

class Frames2d : public testing::TestWithParam<int> {
 protected:
  /// @param x,y  metres
  const std::uint8_t* pixel(float x, float y) {
    return image_.pixel(static_cast<int>(kSideOf2d / 2 + 50 * x), static_cast<int>(kSideOf2d / 2 - 50 * y));
  }
  int brightness(float x, float y) { return pixel(x, y)[0] + pixel(x, y)[1] + pixel(x, y)[2]; }
  void draw(const Frame2d& frame) {
    renderer_.render(frame);
    image_ = renderer_.pixels();
  }
  std::array<int, 3> rgb(float x, float y) { return {pixel(x, y)[0], pixel(x, y)[1], pixel(x, y)[2]}; }

  Renderer renderer_{pinned_context(), {.width = kSideOf2d, .height = kSideOf2d, .samples = GetParam()}};
  Image image_;
  const std::vector<Vertex2d> square_{
      {.position = {-1, -1}}, {.position = {0, -1}}, {.position = {0, 0}}, {.position = {-1, 0}}};
  const Shape2dId square_id_ = renderer_.add_shape(std::array<Triangle, 2>{{{0, 1, 2}, {0, 2, 3}}});
};

TEST_P(Frames2d, ShapesAreWhereTheyAreAndInTheirColour) {
  Frame2d frame = white_paper();
  const std::array<Shape2d, 1> shapes{{{.shape = square_id_, .vertices = square_, .colour = kRed}}};
  frame.shapes = shapes;
  draw(frame);
  EXPECT_EQ(rgb(-0.5f, -0.5f), (std::array{255, 0, 0}));
  for (const auto& [x, y] : {std::pair(0.5f, -0.5f), {0.5f, 0.5f}, {-0.5f, 0.5f}, {-1.1f, -0.5f}})
    EXPECT_EQ(rgb(x, y), (std::array{255, 255, 255})) << x << " " << y;
  frame.centre = {-0.5f, -0.5f};
  draw(frame);
  EXPECT_EQ(rgb(0, 0), (std::array{255, 0, 0})) << "the picture's middle shows the centre";
}

TEST_P(Frames2d, AShapeThatWasRemovedIsNoneAndItsPlaceIsFilledAgain) {
  const Shape2dId other = renderer_.add_shape(std::array<Triangle, 1>{{{0, 1, 2}}});
  renderer_.remove_shape(square_id_);
  Frame2d frame = white_paper();
  const std::array<Shape2d, 1> gone{{{.shape = square_id_, .vertices = square_, .colour = kRed}}};
  frame.shapes = gone;
  EXPECT_THROW(draw(frame), std::invalid_argument);
  EXPECT_THROW(renderer_.remove_shape(square_id_), std::invalid_argument);
  EXPECT_THROW(renderer_.remove_shape({99}), std::invalid_argument);
  const Shape2dId next = renderer_.add_shape(std::array<Triangle, 2>{{{0, 1, 2}, {0, 2, 3}}});
  EXPECT_EQ(next.value, square_id_.value);
  EXPECT_THROW(draw(frame), std::invalid_argument) << "the old handle does not name the new shape";
  const std::array<Shape2d, 2> shapes{{{.shape = next, .vertices = square_, .colour = kRed},
                                       {.shape = other, .vertices = square_, .colour = kRed}}};
  frame.shapes = shapes;
  draw(frame);
  EXPECT_EQ(rgb(-0.5f, -0.5f), (std::array{255, 0, 0}));
}

TEST_P(Frames2d, DotsAndLinesAreAsLargeAsTheySayWithSmoothEdges) {
  Frame2d frame = white_paper();
  const std::array<Vector2f, 1> centre{{{1, 1}}};
  const std::array<Vector2f, 2> ends{{{-1.5f, -1}, {1.5f, -1}}};
  const std::array<Dots2d, 1> dots{{{.centres = centre, .radius = 0.4f}}};
  const std::array<Line2d, 1> lines{{{.points = ends, .width = 0.2f}}};
  frame.dots = dots;
  frame.lines = lines;
  draw(frame);
  double dark = 0;
  int between = 0;
  for (int y = 0; y < kSideOf2d / 2; ++y) {
    for (int x = 0; x < kSideOf2d; ++x) {
      dark += 1 - image_.pixel(x, y)[0] / 255.0;
      between += image_.pixel(x, y)[0] > 0 && image_.pixel(x, y)[0] < 255 ? 1 : 0;
      EXPECT_EQ(image_.pixel(x, y)[3], 255);
    }
  }
  EXPECT_NEAR(dark, 3.14159 * 20 * 20, 15) << "pixels of the disc";
  EXPECT_GT(between, 60) << "at its edge";
  dark = 0;
  for (int y = kSideOf2d / 2; y < kSideOf2d; ++y) {
    for (int x = 0; x < kSideOf2d; ++x) dark += 1 - image_.pixel(x, y)[0] / 255.0;
  }
  EXPECT_NEAR(dark, 150 * 10 + 3.14159 * 5 * 5, 15) << "a line and its round ends";
}

TEST_P(Frames2d, AClosedLineHasTheWidthThatItSays) {
  Frame2d frame = white_paper();
  std::vector<Vector2f> ring;
  for (int i = 0; i < 100; ++i) {
    const double angle = 6.283185307 * i / 100;
    ring.emplace_back(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
  }
  const std::array<Line2d, 1> lines{{{.points = ring, .closed = true, .width = 0.2f}}};
  frame.lines = lines;
  draw(frame);
  double dark = 0;
  for (std::size_t i = 0; i < image_.rgba.size(); i += 4) dark += 1 - image_.rgba[i] / 255.0;
  EXPECT_NEAR(dark, 2 * 3.14159 * 50 * 10, 40);
  EXPECT_EQ(brightness(0, 0), 3 * 255);
}

TEST_P(Frames2d, LinksJoinTheirPoints) {
  Frame2d frame = white_paper();
  const std::vector<Vector2f> points{{-1, 0}, {1, 0}, {0, 1}};
  const std::vector<std::array<std::uint32_t, 2>> one{{{0, 1}}};
  const std::array<Links2d, 1> links{{{.points = points, .links = one, .width = 0.1f}}};
  frame.links = links;
  draw(frame);
  EXPECT_EQ(brightness(0.5f, 0), 0);
  EXPECT_EQ(brightness(0, 0.9f), 3 * 255);
}

TEST_P(Frames2d, ShadowsLieOnThePaperBesideWhatCastsThem) {
  Frame2d frame = white_paper();
  frame.shadow = {.offset = {0.1f, -0.1f}, .blur = 0.02f, .strength = 0.5f};
  std::array<Shape2d, 1> shapes{{{.shape = square_id_, .vertices = square_, .colour = kRed}}};
  frame.shapes = shapes;
  draw(frame);
  EXPECT_EQ(rgb(-0.5f, -0.5f), (std::array{255, 0, 0})) << "none on the shape";
  EXPECT_NEAR(pixel(0.2f, -1.2f)[0], 128, 3) << "0.4 m to the right and down";
  EXPECT_EQ(brightness(0.6f, -0.5f), 3 * 255);
  EXPECT_EQ(brightness(-1.1f, -0.2f), 3 * 255);
  const int edge = pixel(0.4f, -0.9f)[0];
  EXPECT_TRUE(edge > 150 && edge < 230) << "soft: " << edge;
  shapes[0].casts_shadow = false;
  draw(frame);
  EXPECT_EQ(brightness(0.2f, -1.2f), 3 * 255);
}

TEST_P(Frames2d, ATextureIsDrawnWhereItIsOpaque) {
  Image picture(2, 1);
  picture.rgba = {0, 0, 255, 255, 0, 255, 0, 0};  // left blue, right nothing
  Frame2d frame = white_paper();
  std::vector<Vertex2d> square = square_;
  for (Vertex2d& vertex : square) vertex.texture = vertex.position + Vector2f(1, 1);
  const std::array<Shape2d, 1> shapes{
      {{.shape = square_id_, .vertices = square, .texture = renderer_.add_texture(picture)}}};
  frame.shapes = shapes;
  draw(frame);
  const auto blue = rgb(-0.75f, -0.5f);
  EXPECT_NEAR(blue[0], 0, 8);
  EXPECT_NEAR(blue[2], 255, 8);
  EXPECT_EQ(brightness(-0.5f, 0.5f), 3 * 255);
  EXPECT_GT(brightness(-0.25f, -0.5f), brightness(-0.75f, -0.5f)) << "the right half is transparent";
}

TEST_P(Frames2d, OnlyTheChangedPartIsDrawnAnew) {
  Frame2d frame = white_paper();
  std::array<Shape2d, 1> shapes{{{.shape = square_id_, .vertices = square_, .colour = kRed}}};
  frame.shapes = shapes;
  draw(frame);
  shapes[0].colour = srgb(0x0000FF);
  frame.changes = PixelRect{.left = 0, .top = 0, .right = 75, .bottom = kSideOf2d};  // up to x = -0.5
  draw(frame);
  EXPECT_EQ(rgb(-0.8f, -0.5f), (std::array{0, 0, 255}));
  EXPECT_EQ(rgb(-0.2f, -0.5f), (std::array{255, 0, 0}));
}

TEST_P(Frames2d, RefusesWhatDoesNotFit) {
  Frame2d frame = white_paper();
  std::array<Shape2d, 1> shapes{{{.shape = {7}, .vertices = square_}}};
  frame.shapes = shapes;
  EXPECT_THROW(renderer_.render(frame), std::invalid_argument);
  shapes[0] = {.shape = square_id_, .vertices = std::span(square_).first(3)};
  EXPECT_THROW(renderer_.render(frame), std::invalid_argument);
  shapes[0] = {.shape = square_id_, .vertices = square_, .texture = TextureId{99}};
  EXPECT_THROW(renderer_.render(frame), std::invalid_argument);
  frame.shapes = {};
  const std::vector<Vector2f> points{{0, 0}, {1, 1}};
  std::array<Line2d, 1> lines{{{.points = std::span(points).first(1)}}};
  frame.lines = lines;
  EXPECT_THROW(renderer_.render(frame), std::invalid_argument);
  lines[0] = {.points = points, .normals = std::span(points).first(1)};
  EXPECT_THROW(renderer_.render(frame), std::invalid_argument);
  frame.lines = {};
  const std::vector<std::array<std::uint32_t, 2>> wrong{{{0, 2}}};
  const std::array<Links2d, 1> links{{{.points = points, .links = wrong}}};
  frame.links = links;
  EXPECT_THROW(renderer_.render(frame), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Samples, Frames2d, testing::Values(1, 4));

}  // namespace
}  // namespace softcell::render
