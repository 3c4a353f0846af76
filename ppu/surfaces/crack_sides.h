#pragma once
// The sides of cracks within one piece: cells that are near at rest, and may touch all the same.
//
//     +---+---+---+---+
//     | 1 | 1 | 1 | 0 |      a crack from the left, open up to the last particle but one:
//     +===+===+===+---+      cells along it are of one side or the other
//     | 2 | 2 | 2 | 0 |
//     +---+---+---+---+

#include <cstdint>
#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

template <int kDimension>
struct Cracks;

/// Of each cell: 0, or the number of the side that it is on, if it has an open face with another cell of the piece behind it. Cells of one
/// side hang together along the crack by faces that hold. Empty: the piece has no such crack.
template <int kDimension>
std::vector<std::uint32_t> crack_sides(const Lattice<kDimension>& lattice, const Cracks<kDimension>& cracks);
extern template std::vector<std::uint32_t> crack_sides(const Lattice<2>& lattice, const Cracks<2>& cracks);
extern template std::vector<std::uint32_t> crack_sides(const Lattice<3>& lattice, const Cracks<3>& cracks);

/// Whether two cells lie on different sides of cracks, and have no particle in common, as at a crack's end.
bool are_parted(const Lattice<3>& lattice, const std::vector<std::uint32_t>& sides, std::uint32_t a,
                std::uint32_t b);

}  // namespace softcell::ppu
