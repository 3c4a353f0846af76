#pragma once
// Draws frames in three dimensions: a shadow map, then meshes, lattices and the background. Used by Renderer.

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>

#include "gl_objects.h"
#include "material_painter.h"
#include "softcell/render/frame.h"

namespace softcell::render {

class MeshStore;
class RenderTargets;
struct MeshBuffers;
struct TriangleRange;

/// How a Painter3d draws.
struct Painter3dSettings {
  bool soft_shadows = true;  ///< as RendererSettings
  float coarse_pixels = 0;   ///< likewise
  GLuint frame_binding = 0;  ///< of the uniform block
};

/// Made, used and destroyed with its context current.
class Painter3d {
 public:
  /// All that it refers to must outlive it.
  /// @throws std::runtime_error  as make_program().
  Painter3d(const GladGLContext& gl, const RenderTargets& targets, const MeshStore& meshes,
            const Painter3dSettings& settings);
  ~Painter3d();
  Painter3d(const Painter3d&) = delete;
  Painter3d& operator=(const Painter3d&) = delete;

  /// @throws std::invalid_argument  as Renderer::render()
  void check(const FrameDescription& frame) const;
  /// Uploads what all programs read: camera and light. Call it before draw().
  void begin(const FrameDescription& frame);
  /// Draws the shadow map, and `part` of the picture into the targets. @pre check() does not throw; the part is not empty
  void draw(const FrameDescription& frame, const PixelRect& part);

 private:
  struct Program;
  struct Programs;

  float metres_to_move(float distance) const;
  TriangleRange triangles_to_draw(const SkinnedDraw& item) const;
  TriangleRange triangles_to_draw(const StaticDraw& item) const;
  void check_parts(const MeshBuffers& buffers, std::span<const PartDraw> parts) const;
  void upload_lattice(const LatticeDraw& lattice);
  void draw_shadow_map(const FrameDescription& frame);
  void draw_opaque(const FrameDescription& frame);
  void draw_lattice(const LatticeDraw& lattice);
  void draw_background();
  void draw_translucent(const FrameDescription& frame);
  void draw(const MeshBuffers& buffers, const TriangleRange& triangles) const;
  void draw_parts(const MeshBuffers& buffers, std::span<const PartDraw> parts, const Eigen::Matrix4f& pose,
                  float opacity, bool two_sided);
  void cull_back_faces(bool cull) const;
  void draw_surface(const SkinnedDraw& item);
  void draw_surface(const StaticDraw& item);
  void draw_surface(const Program& program, const MeshBuffers& buffers, const TriangleRange& triangles,
                    const Eigen::Matrix4f& pose, const Colour& colour, float opacity) const;
  void draw_shadow(const MeshBuffers& buffers, const Eigen::Matrix4f& pose, float texel) const;

  const GladGLContext& gl_;
  const RenderTargets& targets_;
  const MeshStore& meshes_;
  const float shadow_reach_;  // texels that a lit fragment looks around itself
  const float coarse_pixels_;
  const GLuint frame_binding_;
  Eigen::Vector3f eye_{0, 0, 0};  // of the frame that is drawn
  float pixels_per_tangent_ = 1;  // likewise
  std::unique_ptr<Programs> programs_;
  MaterialPainter materials_;
  GlObject frame_buffer_;  // the uniform block
  GlObject lattice_layout_, lattice_vertices_, lattice_indices_;
  GlObject empty_layout_;  // for the background, which has no vertices
};

}  // namespace softcell::render
