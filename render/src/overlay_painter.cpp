#include "overlay_painter.h"

#include <cstddef>

#include "softcell/base/assert.h"

namespace softcell::render {
namespace {

constexpr char kOverlayVertex[] = R"glsl(#version 330 core
layout(location = 0) in vec2 vertex_position;
layout(location = 1) in vec2 vertex_texel;
layout(location = 2) in vec4 vertex_colour;
uniform vec2 to_clip;  // 2 / picture size
out vec2 texel;
out vec4 colour;
void main() {
  texel = vertex_texel;
  colour = vertex_colour;
  gl_Position = vec4(vertex_position.x * to_clip.x - 1.0, 1.0 - vertex_position.y * to_clip.y, 0.0, 1.0);
}
)glsl";

constexpr char kOverlayFragment[] = R"glsl(#version 330 core
uniform sampler2D picture;  // the font's, or the sheet
uniform bool of_sheet;
in vec2 texel;
in vec4 colour;
out vec4 result;
void main() {
  vec4 seen = texture(picture, texel);
  result = of_sheet ? colour * seen : vec4(colour.rgb, colour.a * seen.r);
}
)glsl";

}  // namespace

OverlayPainter::OverlayPainter(const GladGLContext& gl)
    : gl_(gl),
      program_(make_program(gl, {kOverlayVertex}, {kOverlayFragment})),
      layout_(make_vertex_array(gl)),
      vertices_(make_buffer(gl)),
      indices_(make_buffer(gl)),
      texture_(make_texture(gl)),
      sheet_texture_(make_texture(gl)),
      to_clip_(gl.GetUniformLocation(program_.name(), "to_clip")),
      of_sheet_(gl.GetUniformLocation(program_.name(), "of_sheet")) {
  gl_.BindVertexArray(layout_.name());
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  for (const GLuint attribute : {0u, 1u, 2u}) gl_.EnableVertexAttribArray(attribute);
  constexpr GLsizei kStride = sizeof(OverlayVertex);
  gl_.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, kStride, buffer_offset(offsetof(OverlayVertex, x)));
  gl_.VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, kStride, buffer_offset(offsetof(OverlayVertex, u)));
  gl_.VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride,
                          buffer_offset(offsetof(OverlayVertex, rgba)));
}

void OverlayPainter::upload_font(const OverlayFont& font) {
  gl_.BindTexture(GL_TEXTURE_2D, texture_.name());
  if (uploaded_ == font.coverage.data()) return;
  SC_ASSERT(
      font.coverage.size() == static_cast<std::size_t>(font.width) * static_cast<std::size_t>(font.height),
      "{} texels for a font of {} by {}", font.coverage.size(), font.width, font.height);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, font.width, font.height, 0, GL_RED, GL_UNSIGNED_BYTE,
                 font.coverage.data());
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  uploaded_ = font.coverage.data();
}

void OverlayPainter::upload_sheet(const Image& sheet) {
  if (uploaded_sheet_ == sheet.rgba.data()) return;
  SC_ASSERT(sheet.is_whole(), "{} bytes for a sheet of {} by {} pixels", sheet.rgba.size(), sheet.width,
            sheet.height);
  gl_.BindTexture(GL_TEXTURE_2D, sheet_texture_.name());
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, sheet.width, sheet.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 sheet.rgba.data());
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  uploaded_sheet_ = sheet.rgba.data();
}

void OverlayPainter::draw(const OverlayFont& font, const Image* sheet, const OverlayMesh& mesh, int width,
                          int height) {
  if (sheet != nullptr) upload_sheet(*sheet);
  upload_font(font);
  gl_.Viewport(0, 0, width, height);
  gl_.UseProgram(program_.name());
  gl_.Uniform2f(to_clip_, 2 / static_cast<float>(width), 2 / static_cast<float>(height));
  gl_.BindVertexArray(layout_.name());
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(OverlayVertex)),
                 mesh.vertices.data(), GL_STREAM_DRAW);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)), mesh.indices.data(),
                 GL_STREAM_DRAW);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.Enable(GL_BLEND);
  gl_.Enable(GL_SCISSOR_TEST);
  for (const OverlayCommand& command : mesh.commands) {
    if (command.right <= command.left || command.bottom <= command.top) continue;
    if (command.of_sheet && sheet == nullptr) continue;
    gl_.BindTexture(GL_TEXTURE_2D, command.of_sheet ? sheet_texture_.name() : texture_.name());
    gl_.Uniform1i(of_sheet_, command.of_sheet ? 1 : 0);
    SC_ASSERT(std::size_t{command.first_index} + command.index_count <= mesh.indices.size(),
              "indices {} and {} more of {}", command.first_index, command.index_count, mesh.indices.size());
    gl_.Scissor(command.left, height - command.bottom, command.right - command.left,
                command.bottom - command.top);
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.index_count), GL_UNSIGNED_INT,
                     buffer_offset(std::size_t{command.first_index} * sizeof(std::uint32_t)));
  }
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_DEPTH_TEST);
}

}  // namespace softcell::render
