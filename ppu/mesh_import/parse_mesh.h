#pragma once
// The part of import_mesh() behind the file system, for the fuzzer.

#include <string>
#include <string_view>
#include <vector>

#include "ppu/mesh_import/mesh_file_check.h"
#include "ppu/mesh_import/neighbours.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// @param read_neighbour  finds the files that this one names; null: materials have no pictures, those of an OBJ file
/// names only
/// @param not_read  as ImportReport's; may be null
/// @throws std::runtime_error  a clause that says what is wrong with the file, without its name.
TriangleMesh parse_mesh(std::string_view bytes, MeshFormat format,
                        const ReadNeighbour& read_neighbour = nullptr,
                        std::vector<std::string>* not_read = nullptr);

}  // namespace softcell::ppu
