#pragma once
// The faces between the cells of a lattice, along which it breaks, and the pieces of a lattice when some of them are broken.

#include <cstdint>
#include <span>
#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// The common face of two cells, in two dimensions their common edge: `high` is the next cell after `low` along `axis`.
struct CellFace {
  std::uint32_t low = 0, high = 0;  ///< numbers of cells
  std::uint32_t axis = 0;

  bool operator==(const CellFace&) const = default;
};

/// All faces, ascending by the low cell, then by axis.
template <int kDimension>
std::vector<CellFace> faces_of(const Lattice<kDimension>& lattice);

/// A connected part of a lattice.
template <int kDimension>
struct LatticePiece {
  Lattice<kDimension> lattice;
  std::vector<std::uint32_t> cell_of;  ///< of each cell: its number in the whole
  /// For each particle, the particle of the whole that it is, or is a copy of.
  std::vector<std::uint32_t> particle_of;
};

/// Splits a lattice along its broken faces into pieces. Some faces may have been broken before.
///
/// A particle at a corner of a broken face is split into several at the same place: one for each group of the cells around it that are
/// connected by unbroken faces. Other particles stay one, even if their cells share only an edge or a corner. Cells that share a particle
/// belong to one piece.
/// @param faces   of the lattice
/// @param broken  of each face
/// @return the piece with the most cells first, among equals the one with the first cell; then the others in the order of their first cells
template <int kDimension>
std::vector<LatticePiece<kDimension>> split(const Lattice<kDimension>& lattice,
                                            std::span<const CellFace> faces, const std::vector<bool>& broken);

}  // namespace softcell::ppu
