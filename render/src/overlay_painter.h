#pragma once
// Draws an overlay's triangles into the framebuffer that is bound.

#include "gl_objects.h"
#include "softcell/render/image.h"
#include "softcell/render/overlay_mesh.h"

namespace softcell::render {

class OverlayPainter {
 public:
  /// @pre  the context is current, as for all that follows. @throws std::runtime_error  as make_program().
  explicit OverlayPainter(const GladGLContext& gl);

  /// @param sheet  null: none of its pictures is drawn
  /// Leaves blending off and depth tests on, as the renderer has them.
  void draw(const OverlayFont& font, const Image* sheet, const OverlayMesh& mesh, int width, int height);

 private:
  void upload_font(const OverlayFont& font);
  void upload_sheet(const Image& sheet);

  const GladGLContext& gl_;
  GlObject program_, layout_, vertices_, indices_, texture_, sheet_texture_;
  GLint to_clip_, of_sheet_;
  const std::uint8_t* uploaded_ = nullptr;        ///< the font whose picture the texture is
  const std::uint8_t* uploaded_sheet_ = nullptr;  ///< likewise the sheet
};

}  // namespace softcell::render
