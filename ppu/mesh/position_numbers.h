#pragma once

#include <cstdint>
#include <vector>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// Numbers of positions, from 0 in the order in which they come first: of equal positions the same, whatever their normals.
std::vector<std::uint32_t> number_positions(const TriangleMesh& mesh);

}  // namespace softcell::ppu
