#pragma once
// Draws a soft body in two dimensions: triangles that cover its cells, and its outline. Both consist of particle numbers, so they are made
// once for each model and drawn with the particles' present positions:
//
//     const auto triangles = cell_triangles(model->lattice());   // once
//     ...
//     draw_triangles(body.positions(), triangles);               // each frame

#include <array>
#include <cstdint>
#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// Two triangles for each cell, counter-clockwise, in the order of the lattice's cells.
std::vector<std::array<std::uint32_t, 3>> cell_triangles(const Lattice<2>& lattice);

/// The lattice's boundary as closed loops: those around the body counter-clockwise, those around its holes clockwise, the last particle of
/// each joined to its first. Where cells touch in one corner only, loops meet and do not cross. Deterministic.
///
/// A body that is drawn so is smaller than it collides: other things stay SoftBodyModel<2>::contact_radius() away from this outline, by
/// circles around its particles with ContactMethod::kSpheres, else by the edge of make_skin_2d().
std::vector<std::vector<std::uint32_t>> outline(const Lattice<2>& lattice);

}  // namespace softcell::ppu
