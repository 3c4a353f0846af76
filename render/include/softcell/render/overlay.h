#pragma once
// Text, tables and plots over the picture, with Dear ImGui. We use its widgets and draw them ourselves, so that they work in every context.
// The font is DejaVu Sans if it is installed, else Dear ImGui's own.

#include "softcell/render/overlay_mesh.h"

struct ImGuiContext;

namespace softcell::render {

/// A context of Dear ImGui. Call ImGui's functions between begin() and end(): they draw into this overlay.
/// One thread at a time uses it. Several may exist; one of them is current.
///
///     overlay.begin(renderer.width(), renderer.height(), 1.0f / 60);
///     ImGui::Text("...");
///     renderer.draw_overlay(overlay.font(), overlay.end());
class Overlay {
 public:
  /// @param scale  size of the font, above 0; 1 is 14 pixels high, or 13 with Dear ImGui's own font.
  explicit Overlay(float scale = 1);
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  /// The font's picture, valid as long as the overlay. @pre this is the current context
  OverlayFont font() const;

  /// Begins a frame. @param width,height  of the picture, pixels  @param seconds  time since the last frame, above 0, for animations
  void begin(int width, int height, float seconds);

  /// Ends the frame. @return  what was drawn; valid until the next begin()
  const OverlayMesh& end();

  /// The texture to pass to ImGui::Image() and the like for a part of the sheet of pictures; see Renderer::draw_overlay().
  static void* sheet();

  /// Makes this Dear ImGui's current context, so that ImGui's input functions concern it.
  void make_current();

 private:
  ImGuiContext* context_;
  OverlayMesh mesh_;
};

}  // namespace softcell::render
