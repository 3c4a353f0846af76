#pragma once

#include <Eigen/Core>
#include <vector>

#include "field_reader.h"
#include "scene_source.h"

namespace softcell::demos {

/// The cells of a 2D soft body: its field `rows`, a picture in text; `shape`, a primitive; or `lattice`, a
/// Lua file. These are the last fields that are read of the body: what else it has is refused.
/// @throws SceneError
std::vector<Eigen::Vector2i> read_lattice_2d(FieldReader& body, const SceneSource& source);

}  // namespace softcell::demos
