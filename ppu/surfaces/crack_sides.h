#pragma once
// Finds the sides of cracks within one piece: their cells are close to each other at rest, and yet may collide.
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

/// For each cell: the number of the side that it is on, if one of its faces is open and another cell of the piece lies behind that face;
/// else 0. Cells of one side are connected along the crack by unbroken faces. The result is empty if the piece has no such crack.
template <int kDimension>
std::vector<std::uint32_t> crack_sides(const Lattice<kDimension>& lattice, const Cracks<kDimension>& cracks);
extern template std::vector<std::uint32_t> crack_sides(const Lattice<2>& lattice, const Cracks<2>& cracks);
extern template std::vector<std::uint32_t> crack_sides(const Lattice<3>& lattice, const Cracks<3>& cracks);

/// Whether two cells lie on different sides of cracks and have no particle in common. (Cells at a crack's end have one.)
bool are_parted(const Lattice<3>& lattice, const std::vector<std::uint32_t>& sides, std::uint32_t a,
                std::uint32_t b);

}  // namespace softcell::ppu
