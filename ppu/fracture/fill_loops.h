#pragma once
// Fills loops in a plane with triangles.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace softcell::ppu {

/// Triangles whose sides, except for those that cancel each other, are exactly the sides of the loops, each once: no point is added or left
/// out, whatever the loops look like. Simple loops, counter-clockwise around the area to be filled and clockwise around its holes, are
/// filled without overlaps.
/// @param points  any unit
/// @param loops   numbers of points, three or more in each loop
std::vector<std::array<std::uint32_t, 3>> fill_loops(std::span<const Eigen::Vector2d> points,
                                                     std::vector<std::vector<std::uint32_t>> loops);

}  // namespace softcell::ppu
