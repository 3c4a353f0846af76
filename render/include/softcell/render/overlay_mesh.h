#pragma once
// The overlay of a picture (text, tables, plots) as triangles. The renderer draws them; in softcell's sources, overlay.h makes them.

#include <cstdint>
#include <span>
#include <vector>

namespace softcell::render {

/// A vertex as Dear ImGui makes it, in pixels from the upper left corner. [imgui.h, ImDrawVert] documented
struct OverlayVertex {
  float x, y;
  float u, v;
  std::uint32_t rgba;  ///< r in the lowest byte; encoded as on the screen
};

/// Triangles within a rectangle of the picture.
struct OverlayCommand {
  int left, top, right, bottom;  ///< pixels
  std::uint32_t first_index;
  std::uint32_t index_count;
  bool of_sheet = false;  ///< it uses the sheet of pictures, not the font
};

/// One frame's overlay: triangles over the font's picture or a sheet of pictures, in order.
struct OverlayMesh {
  std::vector<OverlayVertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<OverlayCommand> commands;
};

/// The font's picture: one byte of coverage a texel.
struct OverlayFont {
  int width = 0, height = 0;
  std::span<const std::uint8_t> coverage;
};

}  // namespace softcell::render
