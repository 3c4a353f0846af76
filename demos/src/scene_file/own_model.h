#pragma once
// The model that the user gives with --mesh, and how finely it is covered with cells.

#include <filesystem>
#include <optional>

#include "scene_library.h"

namespace softcell::demos {

/// Of the longest edge of a tessellated mesh, in cells.
inline constexpr float kLeastTessellation = 0.125f, kMostTessellation = 100;

struct OwnModelOptions {
  std::optional<std::filesystem::path> mesh;  ///< the user's own model
  bool z_up = false;                          ///< its z axis points upwards, not its y axis
  /// Metres of one unit of the model; none: the model is scaled to the size of what it replaces.
  std::optional<double> unit = {};
  int cells = 8;               ///< along the model's longest side
  std::optional<double> cell;  ///< their size in the model's own units, above 0, in place of `cells`
  std::optional<float> tessellation = {};  ///< longer edges of its triangles are halved: cells
};

/// @return the model, centred; none when the options give none.
/// @throws std::runtime_error  the file holds no model, or its lattice would be too fine or too coarse; the
///                             sentence names the option and has the model's own units.
std::optional<OwnModel> load_own_model(const OwnModelOptions& options);

}  // namespace softcell::demos
