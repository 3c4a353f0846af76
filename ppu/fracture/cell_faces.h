#pragma once
// The faces between the cells of a lattice, which are what breaks, and what a lattice falls into when some of them are broken.

#include <cstdint>
#include <span>
#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// What two cells have in common, in two dimensions an edge of both: `high` is the next one of `low` along `axis`.
struct CellFace {
  std::uint32_t low = 0, high = 0;  ///< numbers of cells
  std::uint32_t axis = 0;

  bool operator==(const CellFace&) const = default;
};

/// Ascending by the low cell, then by axis.
template <int kDimension>
std::vector<CellFace> faces_of(const Lattice<kDimension>& lattice);

/// A part of a lattice that hangs together.
template <int kDimension>
struct LatticePiece {
  Lattice<kDimension> lattice;
  std::vector<std::uint32_t> cell_of;  ///< of each cell: which one of the whole it is
  std::vector<std::uint32_t>
      particle_of;  ///< of each particle: which one of the whole it is, or is a copy of
};

/// The pieces of a lattice, of which a face may have been broken before.
///
/// A particle at a corner of a broken face becomes several, at the same place: one for each group of the cells around it that hang
/// together by faces that hold. Other particles stay one, also where cells have an edge or a corner in common and no face. Cells that
/// have a particle in common are one piece.
/// @param faces   of the lattice
/// @param broken  of each face
/// @return the piece with the most cells first, of equals that with the first cell; then the others in the order of their first cells
template <int kDimension>
std::vector<LatticePiece<kDimension>> split(const Lattice<kDimension>& lattice,
                                            std::span<const CellFace> faces, const std::vector<bool>& broken);

}  // namespace softcell::ppu
