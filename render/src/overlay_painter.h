#pragma once
// Draws an overlay's triangles into the framebuffer that is bound.

#include "gl_objects.h"
#include "softcell/render/overlay_mesh.h"

namespace softcell::render {

class OverlayPainter {
 public:
  /// @pre  the context is current, as for all that follows. @throws std::runtime_error  as make_program().
  explicit OverlayPainter(const GladGLContext& gl);

  /// Leaves blending off and depth tests on, as the renderer has them.
  void draw(const OverlayFont& font, const OverlayMesh& mesh, int width, int height);

 private:
  void upload_font(const OverlayFont& font);

  const GladGLContext& gl_;
  GlObject program_, layout_, vertices_, indices_, texture_;
  GLint to_clip_;
  const std::uint8_t* uploaded_ = nullptr;  ///< the font whose picture the texture is
};

}  // namespace softcell::render
