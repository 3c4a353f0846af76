#pragma once
// The model that the user gives with --mesh, and how finely it is covered with cells.

#include <optional>

#include "options.h"
#include "scene_file/scene_library.h"

namespace softcell::demos {

/// @return the model, centred; none when the options give none.
/// @throws UsageError          --cell is no length.
/// @throws std::runtime_error  the file holds no model, or its lattice would be too fine or too coarse; the
///                             sentence names the option and has the model's own units.
std::optional<OwnModel> load_own_model(const Demo3dOptions& options);

}  // namespace softcell::demos
