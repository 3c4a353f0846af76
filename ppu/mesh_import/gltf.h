#pragma once
// glTF 2.0. JSON is read by nlohmann/json, pictures by libpng and libjpeg-turbo; between them every index, range and type
// is checked where it is used. Two libraries of Debian 12 do this part, too, and do not take the checks off our hands: assimp
// 5.2 skips or repairs what is broken, so that a check before it would have to read all that is read here, and tinygltf 2.7
// leaves the checks to its user.

#include <string>
#include <string_view>
#include <vector>

#include "ppu/mesh_import/neighbours.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// @param read_neighbour  finds buffers and pictures; null: no file is opened   @param not_read  as ImportReport's
/// @throws std::runtime_error  a clause that says what is wrong with the file, without its name.
TriangleMesh parse_gltf(std::string_view file, const ReadNeighbour& read_neighbour,
                        std::vector<std::string>& not_read);

}  // namespace softcell::ppu
