#pragma once
// Text, tables and plots over the picture, by Dear ImGui: its widgets, our drawing, so that it works in every
// context and gives the same picture everywhere.

#include "softcell/render/overlay_mesh.h"

struct ImGuiContext;

namespace softcell::render {

/// One context of Dear ImGui. Between begin() and end() its functions may be called; they draw into it. Used
/// by one thread at a time; several may exist, one after the other being current.
///
///     overlay.begin(renderer.width(), renderer.height(), 1.0f / 60);
///     ImGui::Text("...");
///     renderer.draw_overlay(overlay.font(), overlay.end());
class Overlay {
 public:
  /// @param scale  of the font: 1 is 13 pixels high; above 0.
  explicit Overlay(float scale = 1);
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  OverlayFont font() const;

  /// @param seconds  since the frame before, above 0: what animations go by.
  void begin(int width, int height, float seconds);

  /// The mesh stays valid until the next begin().
  const OverlayMesh& end();

  /// Makes it Dear ImGui's current context, for handing it input.
  void make_current();

 private:
  ImGuiContext* context_;
  OverlayMesh mesh_;
};

}  // namespace softcell::render
