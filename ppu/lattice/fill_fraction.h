#pragma once
// Measures how much of each lattice cell lies inside the mesh.

#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

inline constexpr float kLeastFill = 0.25f;  ///< even a cell that is hardly touched carries mass

/// The filled share of each cell of the lattice, kLeastFill..1, measured along 16 lines per cell along z. A point of a line is inside where
/// the surface winds around it. A line that does not end outside (the mesh leaks there, or its faces point both ways) is ignored; a cell
/// without any valid line counts as half full.
/// @pre  Cell indices count from 0.
std::vector<float> fill_fractions(const TriangleMesh& mesh, const Lattice<3>& lattice);

}  // namespace softcell::ppu
