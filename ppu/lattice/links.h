#pragma once
// Which particles of a lattice are linked.

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// Of each particle: the particles with which it shares a cell, as Lattice::neighbours has them. By its corners.
template <int kDimension>
Csr find_neighbours(const Lattice<kDimension>& lattice);

}  // namespace softcell::ppu
