#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace softcell::ppu {

/// Numbers of positions, from 0 in the order in which they come first: of equal positions the same, whatever their normals.
std::vector<std::uint32_t> number_positions(std::span<const Eigen::Vector3f> positions);

}  // namespace softcell::ppu
