#pragma once
// The overlay of a picture (text, tables, plots) as triangles. The renderer draws them; in softcell's sources, overlay.h makes them.

#include <cstdint>
#include <span>
#include <vector>

namespace softcell::render {

/// A vertex as Dear ImGui makes it, in pixels from the upper left corner. [imgui.h, ImDrawVert] documented
struct OverlayVertex {
  float x = 0, y = 0;
  float u = 0, v = 0;      ///< in the font's picture or the sheet, 0..1
  std::uint32_t rgba = 0;  ///< r in the lowest byte; encoded as on the screen
};

/// Triangles within a rectangle of the picture.
struct OverlayCommand {
  int left = 0, top = 0, right = 0, bottom = 0;  ///< pixels; `right` and `bottom` are the first outside
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
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
