#include "cell_skinner.h"

#include <stdexcept>
#include <string>

#include "softcell/base/assert.h"

namespace softcell::render {
namespace {

// The trilinear map of a cell as a polynomial in the vertex's place, term by term as the kernel `skin` has
// it: what is left between the two is how each operation rounds. Vertices become binary16, too, to the
// nearest (ties to even, where the kernel's go away from zero); a GPU that drew them unrounded would show
// edges up to half a unit away.
constexpr char kVertex[] = R"glsl(#version 330 core
layout(location = 0) in uvec4 lower_corners;  // corner k = bx + 2 by + 4 bz of the cell
layout(location = 1) in uvec4 upper_corners;
layout(location = 2) in vec3 place;           // in the cell, 0..1
layout(location = 3) in vec3 rest_normal;
uniform samplerBuffer corners;
uniform vec3 origin;
flat out uvec4 skinned;  // eight binary16 numbers: position and 1, normal and 0

vec3 corner(uint index) { return texelFetch(corners, int(index)).xyz - origin; }

// Below the smallest normal number 0, beyond the largest infinity.
uint half_of(float x) {
  uint bits = floatBitsToUint(x);
  uint magnitude = bits & 0x7FFFFFFFu;
  uint rebiased = magnitude - 0x38000000u;  // the exponent from 127 to 15
  uint rounded = (rebiased + 0xFFFu + ((magnitude >> 13) & 1u)) >> 13;
  return ((bits >> 16) & 0x8000u) | (magnitude < 0x38800000u ? 0u : min(rounded, 0x7C00u));
}
uint halves(float low, float high) { return half_of(low) | (half_of(high) << 16); }

void main() {
  vec3 x0 = corner(lower_corners.x), x1 = corner(lower_corners.y);
  vec3 x2 = corner(lower_corners.z), x3 = corner(lower_corners.w);
  vec3 x4 = corner(upper_corners.x), x5 = corner(upper_corners.y);
  vec3 x6 = corner(upper_corners.z), x7 = corner(upper_corners.w);
  vec3 cx = x1 - x0, cy = x2 - x0, cz = x4 - x0;
  vec3 upper = x5 - x4;
  vec3 cxy = (x3 - x2) - cx;
  vec3 cyz = (x6 - x4) - cy;
  vec3 czx = upper - cx;
  vec3 cxyz = ((x7 - x6) - upper) - cxy;

  vec3 along_xy = cxyz * place.z + cxy;
  vec3 along_y = cyz * place.z + cy;
  vec3 f1 = along_xy * place.y + (czx * place.z + cx);  // the columns of the deformation gradient
  vec3 f2 = along_xy * place.x + along_y;
  vec3 f3 = (cxyz * place.x + cyz) * place.y + (czx * place.x + cz);
  vec3 position = f1 * place.x + (along_y * place.y + (cz * place.z + x0));

  // cof(F) N, and where the cell is flat and that vanishes, what is left of N.
  const float kFlat = 1e-12;
  vec3 across = f3 * rest_normal.x - f1 * rest_normal.z;
  vec3 normal = normalize(cross(f2, across) + rest_normal.y * cross(f3, f1) + kFlat * rest_normal);

  skinned = uvec4(halves(position.x, position.y), halves(position.z, 1.0), halves(normal.x, normal.y),
                  halves(normal.z, 0.0));
  gl_Position = vec4(0.0);  // nothing is drawn
}
)glsl";

void check_corners(std::span<const CellVertex> vertices, std::size_t corner_count) {
  for (const CellVertex& vertex : vertices) {
    for (const std::uint32_t corner : vertex.corner) {
      if (corner >= corner_count)
        throw std::invalid_argument("a vertex uses corner " + std::to_string(corner) + " of a mesh with " +
                                    std::to_string(corner_count) + " corners");
    }
  }
}

}  // namespace

CellMesh::CellMesh(const GladGLContext& gl, std::span<const CellVertex> cell_vertices, std::size_t count)
    : layout(make_vertex_array(gl)),
      vertices(make_buffer(gl)),
      corners(make_buffer(gl)),
      texture(make_texture(gl)),
      vertex_count(static_cast<GLsizei>(cell_vertices.size())),
      corner_count(count) {
  check_corners(cell_vertices, count);
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (count > static_cast<std::size_t>(most))
    throw std::invalid_argument(std::to_string(count) + " corners of cells; this OpenGL has room for " +
                                std::to_string(most));

  gl.BindVertexArray(layout.name());
  gl.BindBuffer(GL_ARRAY_BUFFER, vertices.name());
  gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(cell_vertices.size_bytes()), cell_vertices.data(),
                GL_STATIC_DRAW);
  for (const GLuint attribute : {0u, 1u, 2u, 3u}) gl.EnableVertexAttribArray(attribute);
  constexpr GLsizei kStride = sizeof(CellVertex);
  gl.VertexAttribIPointer(0, 4, GL_UNSIGNED_INT, kStride, buffer_offset(offsetof(CellVertex, corner)));
  gl.VertexAttribIPointer(1, 4, GL_UNSIGNED_INT, kStride,
                          buffer_offset(offsetof(CellVertex, corner) + 4 * sizeof(std::uint32_t)));
  gl.VertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, kStride, buffer_offset(offsetof(CellVertex, place)));
  gl.VertexAttribPointer(3, 3, GL_FLOAT, GL_FALSE, kStride, buffer_offset(offsetof(CellVertex, normal)));

  gl.BindBuffer(GL_TEXTURE_BUFFER, corners.name());
  gl.BufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(count * kCellCornerBytes), nullptr,
                GL_STREAM_DRAW);
  gl.BindTexture(GL_TEXTURE_BUFFER, texture.name());
  gl.TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, corners.name());
}

CellSkinner::CellSkinner(const GladGLContext& gl)
    : gl_(gl),
      program_(make_capturing_program(gl, {kVertex}, "skinned")),
      origin_(gl.GetUniformLocation(program_.name(), "origin")) {}

void CellSkinner::skin(const CellMesh& mesh, std::span<const std::byte> corners,
                       const Eigen::Vector3f& origin, const GlObject& out) const {
  const auto size = static_cast<GLsizeiptr>(corners.size());
  SC_ASSERT(corners.size() == mesh.corner_count * kCellCornerBytes, "{} bytes for {} corners", corners.size(),
            mesh.corner_count);
  gl_.BindBuffer(GL_TEXTURE_BUFFER, mesh.corners.name());
  // New storage in place of the old, which a frame in progress may still read.
  gl_.BufferData(GL_TEXTURE_BUFFER, size, nullptr, GL_STREAM_DRAW);
  gl_.BufferSubData(GL_TEXTURE_BUFFER, 0, size, corners.data());

  gl_.UseProgram(program_.name());
  gl_.Uniform3f(origin_, origin.x(), origin.y(), origin.z());
  gl_.BindTexture(GL_TEXTURE_BUFFER, mesh.texture.name());
  gl_.BindVertexArray(mesh.layout.name());
  gl_.BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, out.name());
  gl_.Enable(GL_RASTERIZER_DISCARD);
  gl_.BeginTransformFeedback(GL_POINTS);
  gl_.DrawArrays(GL_POINTS, 0, mesh.vertex_count);
  gl_.EndTransformFeedback();
  gl_.Disable(GL_RASTERIZER_DISCARD);
  gl_.BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
}

}  // namespace softcell::render
