#pragma once
// Triangle meshes from files.

#include <filesystem>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// Reads an OBJ, PLY or STL file (by its extension). Positions that are equal are joined; normals are taken
/// from the file or made, smooth up to a crease. A position whose corners have several normals, texture
/// coordinates or colours becomes as many vertices. Any thread.
///
/// Attributes that are kept: texture coordinates and vertex colours (OBJ, PLY; binary STL has colours of
/// triangles), and parts: objects, groups and materials of OBJ, solids of text STL. Base colours and names of
/// texture files come from the OBJ file's material library if it lies in the same folder; one that is missing
/// or lies elsewhere is ignored. softcell opens no texture.
/// @throws std::runtime_error  one sentence that names the file and what is wrong with it: there is no such
/// file, the format is unknown, the file cannot be read as one, it has no triangles or more than 4 million,
/// a coordinate is NaN or infinite, an index is out of range.
TriangleMesh import_mesh(const std::filesystem::path& path);

}  // namespace softcell::ppu
