#pragma once
// The part of import_mesh() behind the file system, for the fuzzer.

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "ppu/mesh_import/mesh_file_check.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// The bytes of a file that lies beside the mesh's own; none: there is no such file.
using ReadNeighbour = std::function<std::optional<std::string>(const std::string& name)>;

/// @param read_neighbour  finds the material library of an OBJ file; null: materials have names only
/// @throws std::runtime_error  a clause that says what is wrong with the file, without its name.
TriangleMesh parse_mesh(std::string_view bytes, MeshFormat format,
                        const ReadNeighbour& read_neighbour = nullptr);

}  // namespace softcell::ppu
