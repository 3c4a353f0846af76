#pragma once
// Fills loops in a plane with triangles.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace softcell::ppu {

/// Triangles whose sides, where they do not cancel each other, are exactly the sides of the loops, each once: no point is added or left
/// out, whatever the loops look like. Loops that are simple, counter-clockwise around what is to be filled and clockwise around holes in
/// it, are filled without overlaps.
/// @param points  any unit
/// @param loops   numbers of points, three or more a loop
std::vector<std::array<std::uint32_t, 3>> fill_loops(std::span<const Eigen::Vector2d> points,
                                                     std::vector<std::vector<std::uint32_t>> loops);

}  // namespace softcell::ppu
