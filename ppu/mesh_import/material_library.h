#pragma once
// Material libraries of OBJ files (.mtl): what softcell hands on of them. The importing library never sees
// them.

#include <map>
#include <string>
#include <string_view>

#include "softcell/soft_bodies/mesh_material.h"

namespace softcell::ppu {

/// Materials by name. Their textures have file names and no pictures.
using MaterialLibrary = std::map<std::string, MeshMaterial, std::less<>>;

/// Statements other than newmtl, Kd, map_Kd, d, Tr, Pr, Pm and norm are skipped.
/// @throws std::runtime_error  a clause without the file's name: the line, what is wrong, what was expected.
MaterialLibrary parse_material_library(std::string_view text);

}  // namespace softcell::ppu
