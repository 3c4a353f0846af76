#pragma once
// The model that the user gives with --mesh, and how finely it is covered with cells.

#include <filesystem>
#include <optional>

#include "scene_library.h"

namespace softcell::demos {

/// Limits of the longest edge of a tessellated mesh, in cells.
inline constexpr float kLeastTessellation = 0.125f, kMostTessellation = 100;

struct OwnModelOptions {
  std::optional<std::filesystem::path> mesh;  ///< the user's own model
  bool z_up = false;                          ///< its z axis points upwards instead of its y axis
  /// Metres per unit of the model; none: the model is scaled to the size of the body that it replaces.
  std::optional<double> unit = {};
  int cells = 8;               ///< along the model's longest side
  std::optional<double> cell;  ///< size of a cell in the model's own units, above 0, instead of `cells`
  std::optional<float> tessellation = {};  ///< in cells: longer edges of its triangles are halved
};

/// @return the model, centred; none when the options give none.
/// @throws std::runtime_error  the file holds no model, or its lattice would be too fine or too coarse; the message names the option and
/// uses the model's own units.
std::optional<OwnModel> load_own_model(const OwnModelOptions& options);

}  // namespace softcell::demos
