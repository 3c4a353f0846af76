#pragma once
// Finds the cell of a lattice in which a point lies, and its place in the cell.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

struct PlaceInCell {
  std::uint32_t cell = 0;
  Eigen::Vector3d xi{0, 0, 0};  ///< 0..1 along each edge
};

/// The cell with this low corner among these cells, which are ascending as in a lattice.
template <int kDimension>
std::optional<std::uint32_t> find_cell(std::span<const Eigen::Vector<int, kDimension>> cells,
                                       const Eigen::Vector<int, kDimension>& index);
/// The cell with this low corner.
template <int kDimension>
std::optional<std::uint32_t> find_cell(const Lattice<kDimension>& lattice,
                                       const typename Lattice<kDimension>::GridIndex& index);

/// The cell whose half-open box [low, low + 1) holds the point, else, for a point on a face, the first
/// occupied cell beyond that face (x before y before z).
/// @param position  metres, as Lattice::rest_position()
std::optional<PlaceInCell> locate(const Lattice<3>& lattice, const Eigen::Vector3f& position);

}  // namespace softcell::ppu
