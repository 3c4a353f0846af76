#pragma once
// How much of each lattice cell lies inside the mesh.

#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

inline constexpr float kLeastFill = 0.25f;  ///< a cell that is hardly touched still carries mass

/// The filled share of each cell of the lattice, kLeastFill..1, from 16 lines a cell along z: a line is
/// inside where the surface winds around it. A line that does not end outside (the mesh leaks there, or its
/// faces point every way) is left out; a cell with no line left counts as half full.
/// @pre  Cell indices count from 0.
std::vector<float> fill_fractions(const TriangleMesh& mesh, const Lattice<3>& lattice);

}  // namespace softcell::ppu
