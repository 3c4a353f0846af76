#pragma once
// The part of import_mesh() behind the file system, for the fuzzer.

#include <string_view>

#include "ppu/mesh_import/mesh_file_check.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// @throws std::runtime_error  a clause that says what is wrong with the file, without its name.
TriangleMesh parse_mesh(std::string_view bytes, MeshFormat format);

}  // namespace softcell::ppu
