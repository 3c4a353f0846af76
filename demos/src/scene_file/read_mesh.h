#pragma once

#include "field_reader.h"
#include "scene_source.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::demos {

/// The mesh of a soft body or an obstacle: its field `shape`, a primitive, or `mesh`, a file.
/// These are the last fields that are read of the body: what else it has is refused.
/// @throws SceneError
ppu::TriangleMesh read_mesh(FieldReader& body, const SceneSource& source);

}  // namespace softcell::demos
