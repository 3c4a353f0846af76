#pragma once
// Triangle meshes from files.

#include <filesystem>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// Reads an OBJ, PLY or STL file (by its extension). Positions that are equal are joined; normals are taken
/// from the file or made, smooth up to a crease. Any thread.
/// @throws std::runtime_error  one sentence that names the file and what is wrong with it: there is no such
/// file, the format is unknown, the file cannot be read as one, it has no triangles or more than 4 million,
/// a coordinate is NaN or infinite, an index is out of range.
TriangleMesh import_mesh(const std::filesystem::path& path);

}  // namespace softcell::ppu
