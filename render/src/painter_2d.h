#pragma once
// Draws frames in two dimensions. Used by Renderer.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <vector>

#include "gl_objects.h"
#include "numbered.h"
#include "softcell/render/frame_2d.h"

namespace softcell::render {

/// The size of what a Painter2d draws.
struct Canvas2d {
  int width = 0, height = 0;  ///< pixels
  PixelRect part;             ///< what is drawn anew; not empty
};

/// Made, used and destroyed with its context current. After the first frames it allocates no memory itself.
class Painter2d {
 public:
  explicit Painter2d(const GladGLContext& gl);

  /// @throws std::invalid_argument  more indices than OpenGL counts
  Shape2dId add_shape(std::span<const std::array<std::uint32_t, 3>> triangles);
  /// @throws std::invalid_argument  there is no such shape
  void remove_shape(Shape2dId shape);

  /// @throws std::invalid_argument  there is no such shape, it has too few vertices, or a link is out of range
  void check(const Frame2d& frame) const;

  /// Draws into framebuffer(), which keeps the picture. It has one sample a pixel: lines smooth the edges, and
  /// llvmpipe cuts off samples of single pixels at the border of a part that is drawn anew.
  /// @param texture  the GL name of a texture  @pre check() does not throw
  void draw(const Frame2d& frame, const Canvas2d& canvas, const std::function<GLuint(TextureId)>& texture);

  /// @pre draw() was called
  GLuint framebuffer() const { return picture_.framebuffer.name(); }

 private:
  struct Program {
    Program(const GladGLContext& gl, const char* vertex, const char* fragment,
            std::initializer_list<const char*> uniforms);
    GlObject object;
    std::vector<GLint> places;  // of the uniforms, in their order
  };
  struct Triangles {
    GlObject indices;
    GLsizei index_count = 0;
    std::size_t vertices_needed = 0;
  };
  /// A texture that is drawn into.
  struct Target {
    GlObject framebuffer, texture;
  };
  /// Mirrored by kStroke2dVertex.
  struct StrokeVertex {
    Eigen::Vector2f position, across;
    float radius;
    std::uint32_t rgba;
  };

  /// @throws std::invalid_argument  there is no such shape
  const Triangles& triangles_of(Shape2dId shape) const;
  void make_targets(int width, int height);
  Target make_target(GLint format, int width, int height) const;
  void upload_shapes(std::span<const Shape2d> shapes);
  void draw_shadows(const Frame2d& frame, const Canvas2d& canvas,
                    const std::function<GLuint(TextureId)>& texture);
  void blur(const Frame2d& frame, const Canvas2d& canvas);
  void draw_paper(const Frame2d& frame, const Canvas2d& canvas);
  void draw_shapes(const Frame2d& frame, const Canvas2d& canvas,
                   const std::function<GLuint(TextureId)>& texture);
  void draw_triangles(const Shape2d& shape, std::size_t index) const;
  void collect(const Line2d& line, float pixels);
  void collect(const Links2d& links, float pixels);
  void collect(const Dots2d& dots, float pixels);
  void add_stretch(const Eigen::Vector2f& from, const Eigen::Vector2f& to, float radius, float pixels,
                   std::uint32_t rgba);
  void add_square(const std::array<StrokeVertex, 4>& corners);
  /// Draws what was collected, and forgets it.
  void draw_strokes(const Frame2d& frame, const Canvas2d& canvas);

  const GladGLContext& gl_;
  Program shape_, textured_shape_, mask_, textured_mask_, blur_, paper_, stroke_;
  GlObject shape_layout_, shape_vertices_, stroke_layout_, stroke_vertices_, stroke_indices_, empty_layout_;
  Numbered<Shape2dId, Triangles> shapes_{"shape"};

  // The shadow: what casts it in half the picture's resolution, and blurred along x and y in a quarter.
  Target mask_target_, blurred_along_x_, blurred_;
  Target picture_;
  int width_ = 0, height_ = 0;                  // pixels
  int quarter_width_ = 0, quarter_height_ = 0;  // texels

  // The frame in making.
  std::vector<std::size_t> first_vertex_;  // of each shape
  std::vector<StrokeVertex> strokes_;
  std::vector<std::uint32_t> stroke_triangles_;
};

}  // namespace softcell::render
