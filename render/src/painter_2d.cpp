#include "painter_2d.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>

#include "shaders_2d.h"
#include "softcell/base/assert.h"

namespace softcell::render {
namespace {

using Eigen::Vector2f;

constexpr int kHalf = 2, kQuarter = 4;  // the picture's pixels in a texel
// Of the blur, on either side, enough for a height of 16,384 pixels: the shader has one weight more.
constexpr int kMaxTaps = 91;
constexpr float kSmooth = 1;  // pixels around a line that its smooth edge needs

/// Linear light to sRGB, as in shaders.h.
Colour encoded(const Colour& linear) {
  Colour result;
  for (int i = 0; i < 3; ++i) {
    const float x = std::clamp(linear[i], 0.0f, 1.0f);
    const float s1 = std::sqrt(x), s2 = std::sqrt(s1), s3 = std::sqrt(s2);
    result[i] =
        std::clamp(0.662002687f * s1 + 0.684122060f * s2 - 0.323583601f * s3 - 0.0225411470f * x, 0.0f, 1.0f);
  }
  return result;
}

std::uint32_t rgba8(const Colour& linear, float opacity) {
  const auto byte = [](float share) { return static_cast<std::uint32_t>(share * 255 + 0.5f); };
  const Colour colour = encoded(linear);
  return byte(colour.x()) | byte(colour.y()) << 8 | byte(colour.z()) << 16 |
         byte(std::clamp(opacity, 0.0f, 1.0f)) << 24;
}

/// Computes the weights of a curve that falls to 0 at `reach` texels, one number for both sides; together they are 1. Biweight: no
/// libm.
int blur_weights(float reach, std::array<float, kMaxTaps + 1>& weights) {
  const int taps = std::clamp(static_cast<int>(reach), 0, kMaxTaps);
  float sum = 0;
  for (int i = 0; i <= taps; ++i) {
    const float share = static_cast<float>(i) / std::max(reach, 1.0f);
    const float height = std::max(1 - share * share, 0.0f);
    weights[static_cast<std::size_t>(i)] = height * height;
    sum += (i == 0 ? 1 : 2) * height * height;
  }
  for (int i = 0; i <= taps; ++i) weights[static_cast<std::size_t>(i)] /= sum;
  return taps;
}

}  // namespace

Painter2d::Program::Program(const GladGLContext& gl, const char* vertex, const char* fragment,
                            std::initializer_list<const char*> uniforms)
    : object(make_program(gl, {vertex}, {fragment})) {
  for (const char* const uniform : uniforms) places.push_back(gl.GetUniformLocation(object.name(), uniform));
}

Painter2d::Painter2d(const GladGLContext& gl)
    : gl_(gl),
      shape_(gl, kShape2dVertex, kShape2dFragment, {"centre", "to_clip", "colour", "hatching"}),
      textured_shape_(gl, kShape2dVertex, kTexturedShape2dFragment, {"centre", "to_clip", "colour"}),
      mask_(gl, kShape2dVertex, kMask2dFragment, {"centre", "to_clip"}),
      textured_mask_(gl, kShape2dVertex, kTexturedMask2dFragment, {"centre", "to_clip"}),
      blur_(gl, kWholePicture2d, kBlur2d, {"texels_per_pixel", "step_in_texels", "taps", "weights"}),
      paper_(gl, kWholePicture2d, kPaper2d,
             {"shadow_size", "middle", "centre", "pixel", "squares", "paper", "line_colour", "strength",
              "line_width"}),
      stroke_(gl, kStroke2dVertex, kStroke2dFragment, {"centre", "to_clip"}),
      shape_layout_(make_vertex_array(gl)),
      shape_vertices_(make_buffer(gl)),
      stroke_layout_(make_vertex_array(gl)),
      stroke_vertices_(make_buffer(gl)),
      stroke_indices_(make_buffer(gl)),
      empty_layout_(make_vertex_array(gl)) {
  gl_.BindVertexArray(shape_layout_.name());
  gl_.BindBuffer(GL_ARRAY_BUFFER, shape_vertices_.name());
  for (const GLuint attribute : {0u, 1u, 2u}) {
    gl_.EnableVertexAttribArray(attribute);
    gl_.VertexAttribPointer(attribute, 2, GL_FLOAT, GL_FALSE, sizeof(Vertex2d),
                            buffer_offset(attribute * sizeof(Vector2f)));
  }
  gl_.BindVertexArray(stroke_layout_.name());
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, stroke_indices_.name());
  gl_.BindBuffer(GL_ARRAY_BUFFER, stroke_vertices_.name());
  constexpr GLsizei kStride = sizeof(StrokeVertex);
  static_assert(kStride == 24);
  for (const GLuint attribute : {0u, 1u, 2u, 3u}) gl_.EnableVertexAttribArray(attribute);
  gl_.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, kStride, buffer_offset(offsetof(StrokeVertex, position)));
  gl_.VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, kStride, buffer_offset(offsetof(StrokeVertex, across)));
  gl_.VertexAttribPointer(2, 1, GL_FLOAT, GL_FALSE, kStride, buffer_offset(offsetof(StrokeVertex, radius)));
  gl_.VertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride,
                          buffer_offset(offsetof(StrokeVertex, rgba)));
}

Shape2dId Painter2d::add_shape(std::span<const std::array<std::uint32_t, 3>> triangles) {
  if (triangles.size() > static_cast<std::size_t>(std::numeric_limits<GLsizei>::max()) / 3)
    throw std::invalid_argument("a shape of " + std::to_string(triangles.size()) + " triangles");
  Triangles shape{.indices = make_buffer(gl_), .index_count = static_cast<GLsizei>(3 * triangles.size())};
  for (const auto& triangle : triangles) {
    for (const std::uint32_t index : triangle)
      shape.vertices_needed = std::max(shape.vertices_needed, std::size_t{index} + 1);
  }
  gl_.BindVertexArray(shape_layout_.name());
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, shape.indices.name());
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size_bytes()), triangles.data(),
                 GL_STATIC_DRAW);
  return shapes_.add(std::move(shape));
}

const Painter2d::Triangles& Painter2d::triangles_of(Shape2dId shape) const { return shapes_.at(shape); }

void Painter2d::remove_shape(Shape2dId shape) { shapes_.remove(shape); }

void Painter2d::check(const Frame2d& frame) const {
  for (const Shape2d& shape : frame.shapes) {
    const std::size_t needed = triangles_of(shape.shape).vertices_needed;
    if (shape.vertices.size() < needed) {
      throw std::invalid_argument(std::to_string(shape.vertices.size()) + " vertices for a shape of " +
                                  std::to_string(needed));
    }
  }
  const auto check_line = [](const Line2d& line) {
    if (line.points.size() < 2)
      throw std::invalid_argument("a line of " + std::to_string(line.points.size()) + " points");
    if (!line.normals.empty() && line.normals.size() != line.points.size())
      throw std::invalid_argument(std::to_string(line.normals.size()) + " normals of a line of " +
                                  std::to_string(line.points.size()) + " points");
  };
  std::ranges::for_each(frame.lines_below, check_line);
  std::ranges::for_each(frame.lines, check_line);
  for (const Links2d& links : frame.links) {
    for (const auto& [a, b] : links.links) {
      if (a >= links.points.size() || b >= links.points.size())
        throw std::invalid_argument("a link joins points " + std::to_string(a) + " and " + std::to_string(b) +
                                    " of " + std::to_string(links.points.size()));
    }
  }
}

Painter2d::Target Painter2d::make_target(GLint format, int width, int height) const {
  Target target{.framebuffer = make_framebuffer(gl_), .texture = make_texture(gl_)};
  gl_.BindTexture(GL_TEXTURE_2D, target.texture.name());
  gl_.TexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const GLenum direction : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl_.TexParameteri(GL_TEXTURE_2D, direction, GL_CLAMP_TO_EDGE);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.name());
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.texture.name(), 0);
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("no framebuffer for a picture or shadows of " + std::to_string(width) + " by " +
                             std::to_string(height) + " texels");
  }
  return target;
}

void Painter2d::make_targets(int width, int height) {
  const int quarter_width = (width + kQuarter - 1) / kQuarter,
            quarter_height = (height + kQuarter - 1) / kQuarter;
  if (width == width_ && height == height_) return;
  constexpr int kFiner = kQuarter / kHalf;
  mask_target_ = make_target(GL_R8, kFiner * quarter_width, kFiner * quarter_height);
  blurred_along_x_ = make_target(GL_R8, quarter_width, quarter_height);
  blurred_ = make_target(GL_R8, quarter_width, quarter_height);
  picture_ = make_target(GL_RGBA8, width, height);
  width_ = width;
  height_ = height;
  quarter_width_ = quarter_width;
  quarter_height_ = quarter_height;
}

void Painter2d::upload_shapes(std::span<const Shape2d> shapes) {
  first_vertex_.clear();
  std::size_t count = 0;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const bool shared = i > 0 && shapes[i].vertices.data() == shapes[i - 1].vertices.data();
    first_vertex_.push_back(shared ? first_vertex_.back() : count);
    count = std::max(count, first_vertex_.back() + shapes[i].vertices.size());
  }
  gl_.BindBuffer(GL_ARRAY_BUFFER, shape_vertices_.name());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(count * sizeof(Vertex2d)), nullptr, GL_STREAM_DRAW);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (i > 0 && first_vertex_[i] == first_vertex_[i - 1] &&
        shapes[i].vertices.size() <= shapes[i - 1].vertices.size()) {
      continue;
    }
    gl_.BufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(first_vertex_[i] * sizeof(Vertex2d)),
                      static_cast<GLsizeiptr>(shapes[i].vertices.size_bytes()), shapes[i].vertices.data());
  }
}

void Painter2d::draw_triangles(const Shape2d& shape, std::size_t index) const {
  const Triangles& triangles = triangles_of(shape.shape);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles.indices.name());
  gl_.DrawElementsBaseVertex(GL_TRIANGLES, triangles.index_count, GL_UNSIGNED_INT, nullptr,
                             static_cast<GLint>(first_vertex_[index]));
}

void Painter2d::draw_shadows(const Frame2d& frame, const Canvas2d& canvas,
                             const std::function<GLuint(TextureId)>& texture) {
  constexpr int kFiner = kQuarter / kHalf;
  // The texels of whole quarters that the part to be drawn has a share of.
  const auto scissor = [&](int finer) {
    const int left = canvas.part.left / kQuarter, bottom = (canvas.height - canvas.part.bottom) / kQuarter;
    const int right = (canvas.part.right + kQuarter - 1) / kQuarter,
              top = (canvas.height - canvas.part.top + kQuarter - 1) / kQuarter;
    gl_.Scissor(finer * left, finer * bottom, finer * (right - left), finer * (top - bottom));
  };
  gl_.BindFramebuffer(GL_FRAMEBUFFER, mask_target_.framebuffer.name());
  gl_.Viewport(0, 0, kFiner * quarter_width_, kFiner * quarter_height_);
  scissor(kFiner);
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  gl_.BindVertexArray(shape_layout_.name());
  // The texture may be a little larger than the picture, whose lower left corner it shares.
  const float pixels = static_cast<float>(canvas.height) / frame.height;
  const Vector2f texture_size =
      Vector2f(static_cast<float>(kQuarter * quarter_width_), static_cast<float>(kQuarter * quarter_height_));
  const Vector2f picture_size(static_cast<float>(canvas.width), static_cast<float>(canvas.height));
  const Vector2f shadow_from =
      frame.centre + (texture_size - picture_size) / (2 * pixels) - frame.height * frame.shadow.offset;
  for (std::size_t i = 0; i < frame.shapes.size(); ++i) {
    const Shape2d& shape = frame.shapes[i];
    if (!shape.casts_shadow) continue;
    const Program& program = shape.texture ? textured_mask_ : mask_;
    gl_.UseProgram(program.object.name());
    gl_.Uniform2f(program.places[0], shadow_from.x(), shadow_from.y());
    gl_.Uniform2f(program.places[1], 2 * pixels / texture_size.x(), 2 * pixels / texture_size.y());
    if (shape.texture) gl_.BindTexture(GL_TEXTURE_2D, texture(*shape.texture));
    draw_triangles(shape, i);
  }
  scissor(1);
  blur(frame, canvas);
}

void Painter2d::blur(const Frame2d& frame, const Canvas2d& canvas) {
  std::array<float, kMaxTaps + 1> weights{};
  const float reach = frame.shadow.blur * static_cast<float>(canvas.height) / kQuarter;
  const int taps = blur_weights(reach, weights);
  constexpr auto kFiner = static_cast<float>(kQuarter / kHalf);
  gl_.UseProgram(blur_.object.name());
  gl_.Uniform1i(blur_.places[2], taps);
  gl_.Uniform1fv(blur_.places[3], kMaxTaps + 1, weights.data());
  gl_.BindVertexArray(empty_layout_.name());
  gl_.Viewport(0, 0, quarter_width_, quarter_height_);
  const auto pass = [&](const Target& from, const Target& to, float finer, const Vector2f& along) {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, to.framebuffer.name());
    gl_.BindTexture(GL_TEXTURE_2D, from.texture.name());
    gl_.Uniform2f(blur_.places[0], finer, finer);
    gl_.Uniform2f(blur_.places[1], finer * along.x(), finer * along.y());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  };
  // A quarter's middle is the corner of four texels of the mask: the filter takes their mean.
  pass(mask_target_, blurred_along_x_, kFiner, {1, 0});
  pass(blurred_along_x_, blurred_, 1, {0, 1});
}

void Painter2d::draw_paper(const Frame2d& frame, const Canvas2d& canvas) {
  const Paper& paper = frame.paper;
  SC_ASSERT(paper.squares > 0, "squares of {} m", paper.squares);
  gl_.UseProgram(paper_.object.name());
  gl_.BindVertexArray(empty_layout_.name());
  gl_.BindTexture(GL_TEXTURE_2D, blurred_.texture.name());
  const auto width = static_cast<float>(canvas.width), height = static_cast<float>(canvas.height);
  const Colour colour = encoded(paper.colour), line = encoded(paper.line_colour);
  gl_.Uniform2f(paper_.places[0], static_cast<float>(kQuarter * quarter_width_),
                static_cast<float>(kQuarter * quarter_height_));
  gl_.Uniform2f(paper_.places[1], width / 2, height / 2);
  gl_.Uniform2f(paper_.places[2], frame.centre.x(), frame.centre.y());
  gl_.Uniform1f(paper_.places[3], frame.height / height);
  gl_.Uniform1f(paper_.places[4], paper.squares);
  gl_.Uniform3f(paper_.places[5], colour.x(), colour.y(), colour.z());
  gl_.Uniform3f(paper_.places[6], line.x(), line.y(), line.z());
  gl_.Uniform1f(paper_.places[7], frame.shadow.strength);
  gl_.Uniform1f(paper_.places[8], std::max(height / 720, 1.0f));  // as wide to the eye in larger pictures
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

void Painter2d::draw_shapes(const Frame2d& frame, const Canvas2d& canvas,
                            const std::function<GLuint(TextureId)>& texture) {
  const auto width = static_cast<float>(canvas.width), height = static_cast<float>(canvas.height);
  const Vector2f to_clip(2 * height / (width * frame.height), 2 / frame.height);
  constexpr float kHatching = 0.016f;  // share of the picture's height
  gl_.BindVertexArray(shape_layout_.name());
  for (std::size_t i = 0; i < frame.shapes.size(); ++i) {
    const Shape2d& shape = frame.shapes[i];
    SC_ASSERT(shape.opacity >= 0 && shape.opacity <= 1, "an opacity of {}", shape.opacity);
    const Program& program = shape.texture ? textured_shape_ : shape_;
    gl_.UseProgram(program.object.name());
    gl_.Uniform2f(program.places[0], frame.centre.x(), frame.centre.y());
    gl_.Uniform2f(program.places[1], to_clip.x(), to_clip.y());
    const Colour colour = encoded(shape.colour);
    gl_.Uniform4f(program.places[2], colour.x(), colour.y(), colour.z(), shape.opacity);
    if (shape.texture) {
      gl_.BindTexture(GL_TEXTURE_2D, texture(*shape.texture));
    } else {
      gl_.Uniform1f(program.places[3], shape.fill == Fill2d::kHatched ? kHatching * height : 0.0f);
    }
    draw_triangles(shape, i);
  }
}

void Painter2d::add_square(const std::array<StrokeVertex, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(strokes_.size());
  strokes_.insert(strokes_.end(), corners.begin(), corners.end());
  for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) stroke_triangles_.push_back(first + corner);
}

/// @param radius  pixels  @param pixels  of a metre
void Painter2d::add_stretch(const Vector2f& from, const Vector2f& to, float radius, float pixels,
                            std::uint32_t rgba) {
  const float length = (to - from).norm();
  const Vector2f along = length > 0 ? Vector2f((to - from) / length) : Vector2f(1, 0);
  const Vector2f across(-along.y(), along.x());
  // Distances from the stretch, in pixels. A point beyond an end is as far from the stretch as from this end.
  const float reach = radius + kSmooth, cap = reach / pixels;
  const auto corner = [&](const Vector2f& end, float beyond, float side) {
    return StrokeVertex{
        end + cap * (beyond * along + side * across), {beyond * reach, side * reach}, radius, rgba};
  };
  // Three squares, so that the distance beyond an end grows within its cap only.
  const auto at_end = [&](const Vector2f& end, float side) {
    return StrokeVertex{end + cap * side * across, {0, side * reach}, radius, rgba};
  };
  add_square({corner(from, -1, -1), at_end(from, -1), at_end(from, 1), corner(from, -1, 1)});
  if (length > 0) add_square({at_end(from, -1), at_end(to, -1), at_end(to, 1), at_end(from, 1)});
  add_square({at_end(to, -1), corner(to, 1, -1), corner(to, 1, 1), at_end(to, 1)});
}

void Painter2d::collect(const Links2d& links, float pixels) {
  const std::uint32_t rgba = rgba8(links.colour, links.opacity);
  for (const auto& [a, b] : links.links)
    add_stretch(links.points[a], links.points[b], 0.5f * links.width * pixels, pixels, rgba);
}

void Painter2d::collect(const Dots2d& dots, float pixels) {
  const std::uint32_t rgba = rgba8(dots.colour, dots.opacity);
  const float radius = dots.radius * pixels, reach = radius + kSmooth;
  for (const Vector2f& centre : dots.centres) {
    const auto corner = [&](float x, float y) {
      const Vector2f away = reach * Vector2f(x, y);
      return StrokeVertex{centre + away / pixels, away, radius, rgba};
    };
    add_square({corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)});
  }
}

void Painter2d::collect(const Line2d& line, float pixels) {
  const std::uint32_t rgba = rgba8(line.colour, line.opacity);
  const std::size_t count = line.points.size();
  const float radius = 0.5f * line.width * pixels, reach = radius + kSmooth;
  const auto normal = [&](std::size_t i) -> Vector2f {
    if (!line.normals.empty()) {
      const float length = line.normals[i].norm();
      return length > 0 ? Vector2f(line.normals[i] / length) : Vector2f(0, 1);
    }
    const std::size_t before = i > 0 ? i - 1 : line.closed ? count - 1 : 0;
    const std::size_t next = i + 1 < count ? i + 1 : line.closed ? 0 : count - 1;
    const Vector2f along = line.points[next] - line.points[before];
    const float length = along.norm();
    return length > 0 ? Vector2f(Vector2f(-along.y(), along.x()) / length) : Vector2f(0, 1);
  };
  const auto first = static_cast<std::uint32_t>(strokes_.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Vector2f side = normal(i);
    for (const float sign : {-1.0f, 1.0f})
      strokes_.push_back({line.points[i] + sign * reach / pixels * side, {0, sign * reach}, radius, rgba});
  }
  const std::size_t stretches = line.closed ? count : count - 1;
  for (std::size_t i = 0; i < stretches; ++i) {
    const auto a = first + static_cast<std::uint32_t>(2 * i),
               b = first + static_cast<std::uint32_t>(2 * ((i + 1) % count));
    for (const std::uint32_t corner : {a, b, b + 1, a, b + 1, a + 1}) stroke_triangles_.push_back(corner);
  }
  if (line.closed) return;
  const auto cap = [&](const Vector2f& end, const Vector2f& before) {
    const Vector2f along = (end - before).normalized(), across(-along.y(), along.x());
    const auto corner = [&](float beyond, float side) {
      return StrokeVertex{end + reach / pixels * (beyond * along + side * across),
                          {beyond * reach, side * reach},
                          radius,
                          rgba};
    };
    add_square({corner(0, -1), corner(1, -1), corner(1, 1), corner(0, 1)});
  };
  cap(line.points[0], line.points[1]);
  cap(line.points[count - 1], line.points[count - 2]);
}

void Painter2d::draw_strokes(const Frame2d& frame, const Canvas2d& canvas) {
  const auto width = static_cast<float>(canvas.width), height = static_cast<float>(canvas.height);
  const float pixels = height / frame.height;
  gl_.BindVertexArray(stroke_layout_.name());
  gl_.BindBuffer(GL_ARRAY_BUFFER, stroke_vertices_.name());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(strokes_.size() * sizeof(StrokeVertex)),
                 strokes_.data(), GL_STREAM_DRAW);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(stroke_triangles_.size() * sizeof(std::uint32_t)),
                 stroke_triangles_.data(), GL_STREAM_DRAW);
  gl_.UseProgram(stroke_.object.name());
  gl_.Uniform2f(stroke_.places[0], frame.centre.x(), frame.centre.y());
  gl_.Uniform2f(stroke_.places[1], 2 * pixels / width, 2 * pixels / height);
  gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(stroke_triangles_.size()), GL_UNSIGNED_INT, nullptr);
  strokes_.clear();
  stroke_triangles_.clear();
}

void Painter2d::draw(const Frame2d& frame, const Canvas2d& canvas,
                     const std::function<GLuint(TextureId)>& texture) {
  SC_ASSERT(frame.height > 0, "a picture of {} m", frame.height);
  SC_ASSERT(canvas.part.left < canvas.part.right && canvas.part.top < canvas.part.bottom,
            "a part of {} by {} pixels", canvas.part.right - canvas.part.left,
            canvas.part.bottom - canvas.part.top);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_SCISSOR_TEST);
  make_targets(canvas.width, canvas.height);
  upload_shapes(frame.shapes);
  draw_shadows(frame, canvas, texture);

  gl_.BindFramebuffer(GL_FRAMEBUFFER, picture_.framebuffer.name());
  gl_.Viewport(0, 0, canvas.width, canvas.height);
  gl_.Scissor(canvas.part.left, canvas.height - canvas.part.bottom, canvas.part.right - canvas.part.left,
              canvas.part.bottom - canvas.part.top);
  draw_paper(frame, canvas);
  gl_.Enable(GL_BLEND);
  // The picture stays opaque, whatever is drawn on it.
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  const float pixels = static_cast<float>(canvas.height) / frame.height;
  for (const Line2d& line : frame.lines_below) collect(line, pixels);
  draw_strokes(frame, canvas);
  draw_shapes(frame, canvas, texture);
  for (const Links2d& links : frame.links) collect(links, pixels);
  for (const Line2d& line : frame.lines) collect(line, pixels);
  for (const Dots2d& dots : frame.dots) collect(dots, pixels);
  draw_strokes(frame, canvas);
  gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl_.Disable(GL_BLEND);
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.Enable(GL_DEPTH_TEST);
}

}  // namespace softcell::render
