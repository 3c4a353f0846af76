#pragma once
// Skinning on the GPU: a vertex shader makes vertices from the corners of the cells that they hang in, and
// transform feedback keeps them in the vertex buffer that is drawn.

#include <cstddef>
#include <span>

#include "gl_objects.h"
#include "softcell/render/renderer.h"

namespace softcell::render {

/// What the shader reads of one mesh.
struct CellMesh {
  /// @throws std::invalid_argument  a vertex speaks of a corner that is not one of the first `corner_count`.
  CellMesh(const GladGLContext& gl, std::span<const CellVertex> vertices, std::size_t corner_count);

  GlObject layout;    ///< of the vertices
  GlObject vertices;  ///< CellVertex, given once
  GlObject corners;   ///< four floats each, given anew for each frame
  GlObject texture;   ///< the corners as texels
  GLsizei vertex_count;
  std::size_t corner_count;
};

class CellSkinner {
 public:
  /// @pre  the context is current, as for all that follows. @throws std::runtime_error  as make_program().
  explicit CellSkinner(const GladGLContext& gl);

  /// Uploads the corners and has the vertices made. Leaves no vertex array and no program bound that anybody
  /// relies on.
  /// @param corners  x y z and anything, corner_count of them  @param origin  is taken off them first
  /// @param out      buffer with room for vertex_count vertices of kSkinnedVertexBytes
  void skin(const CellMesh& mesh, std::span<const std::byte> corners, const Eigen::Vector3f& origin,
            const GlObject& out) const;

 private:
  const GladGLContext& gl_;
  GlObject program_;
  GLint origin_;
};

}  // namespace softcell::render
