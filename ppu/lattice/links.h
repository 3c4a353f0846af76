#pragma once
// Finds the particles of a lattice that are linked.

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// For each particle: the particles with which it shares a cell, as in Lattice::neighbours. Uses Lattice::corners.
template <int kDimension>
Csr find_neighbours(const Lattice<kDimension>& lattice);

}  // namespace softcell::ppu
