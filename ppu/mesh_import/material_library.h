#pragma once
// Material libraries of OBJ files (.mtl): what softcell hands on of them. The importing library never sees
// them.

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace softcell::ppu {

struct Material {
  std::optional<Eigen::Vector3f> base_colour;  ///< Kd, 0..1
  std::string texture;                         ///< the file name of map_Kd
};

using MaterialLibrary = std::map<std::string, Material, std::less<>>;

/// Statements other than newmtl, Kd and map_Kd are skipped.
/// @throws std::runtime_error  a clause without the file's name: the line, what is wrong, what was expected.
MaterialLibrary parse_material_library(std::string_view text);

}  // namespace softcell::ppu
