#pragma once
// One frame in two dimensions as plain data: shapes, lines and dots on paper. Metres, y up. Spans must live until
// render() returns.
//
// Everything lies in one plane, seen straight on. Shapes cast soft shadows on the paper only. Lines and dots have smooth edges whether or
// not the context has several samples per pixel; to smooth the edge of a shape, draw a line along its outline.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "softcell/render/frame.h"

namespace softcell::render {

/// Handle to the triangles of one Renderer's shape.
struct Shape2dId {
  std::uint32_t value = 0;
  std::uint32_t generation = 0;  ///< 0: the handle names nothing
};

/// A corner of a shape's triangles.
struct Vertex2d {
  Eigen::Vector2f position{0, 0};  ///< metres
  Eigen::Vector2f slope{0, 0};     ///< which way the surface falls there, and how steeply; level: (0, 0)
  Eigen::Vector2f texture{0, 0};   ///< (0, 0) is the lower left corner of the texture
};
static_assert(sizeof(Vertex2d) == 24, "uploaded as it is");

enum class Fill2d : std::uint8_t {
  kPlain,
  kHatched,  ///< with slanting lines, as drawings show fixed objects
};

/// Triangles of one colour, lit from the upper left.
struct Shape2d {
  Shape2dId shape = {};
  std::span<const Vertex2d> vertices;  ///< successive shapes that share their vertices upload them once
  Colour colour{0.8f, 0.8f, 0.8f};
  float opacity = 1;
  Fill2d fill = Fill2d::kPlain;
  bool casts_shadow = true;
  std::optional<TextureId> texture = {};  ///< instead of the colour; its alpha cuts holes
};

/// A line through points, with round ends.
struct Line2d {
  std::span<const Eigen::Vector2f> points;  ///< two at least
  /// The direction in which each point's edge is pushed: of any length above 0. Empty: the line's own normals.
  std::span<const Eigen::Vector2f> normals = {};
  bool closed = false;
  float width = 0.01f;  ///< metres
  Colour colour{0, 0, 0};
  float opacity = 1;
};

/// Straight lines between pairs of points.
struct Links2d {
  std::span<const Eigen::Vector2f> points;
  std::span<const std::array<std::uint32_t, 2>> links;  ///< indices into `points`
  float width = 0.01f;                                  ///< metres
  Colour colour{0, 0, 0};
  float opacity = 1;
};

/// Discs of one size.
struct Dots2d {
  std::span<const Eigen::Vector2f> centres;
  float radius = 0.02f;  ///< metres
  Colour colour{0, 0, 0};
  float opacity = 1;
};

/// The paper that the shapes lie on: squared.
struct Paper {
  Colour colour = srgb(0xF6F1E6);
  Colour line_colour = srgb(0x7FA3C4);
  float squares = 0.25f;  ///< side of a square, metres; every fourth line is stronger
};

/// The shapes' shadows; lengths are shares of the picture's height.
struct Shadow2d {
  Eigen::Vector2f offset{0.010f, -0.015f};
  float blur = 0.022f;     ///< how far outwards and inwards an edge is spread
  float strength = 0.30f;  ///< 0..1: how much of the light is taken
};

/// Everything that one picture shows: the paper with the shadows, then lines, shapes, links, lines and dots, each in order.
struct Frame2d {
  Eigen::Vector2f centre{0, 0};  ///< of what the picture shows, metres
  float height = 10;             ///< of what the picture shows, metres
  Paper paper = {};
  Shadow2d shadow = {};
  std::span<const Line2d> lines_below = {};  ///< shapes cover them
  std::span<const Shape2d> shapes = {};
  std::span<const Links2d> links = {};
  std::span<const Line2d> lines = {};
  std::span<const Dots2d> dots = {};
  /// Outside of this rectangle the picture is the same as in the last frame: see FrameDescription::changes.
  std::optional<PixelRect> changes = {};
};

}  // namespace softcell::render
