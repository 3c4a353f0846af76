#pragma once
// glTF 2.0. Of its libraries that Debian 12 has, assimp 5.2 looks up indices of a file before it checks them, and tinygltf
// leaves that to its user; what is left of their work is to name the fields. So here JSON is read by nlohmann/json,
// pictures by libpng and libjpeg-turbo, and between them every index, range and type is checked where it is used.

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
