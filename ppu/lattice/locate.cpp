#include "ppu/lattice/locate.h"
#include "softcell/base/assert.h"

#include <algorithm>

namespace softcell::ppu {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// How far beyond a face, in cells, a point may lie and still belong to the cell behind it. The lattice is computed in float: over 256
/// cells its faces are off by 2e-5 of a cell.
constexpr double kFaceTolerance = 1e-4;

}  // namespace

template <int kDimension>
std::optional<std::uint32_t> find_cell(std::span<const Eigen::Vector<int, kDimension>> cells,
                                       const Eigen::Vector<int, kDimension>& index) {
  const auto before = [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.data(), a.data() + kDimension, b.data(), b.data() + kDimension);
  };
  const auto found = std::lower_bound(cells.begin(), cells.end(), index, before);
  if (found == cells.end() || *found != index) return std::nullopt;
  return static_cast<std::uint32_t>(found - cells.begin());
}

template <int kDimension>
std::optional<std::uint32_t> find_cell(const Lattice<kDimension>& lattice,
                                       const typename Lattice<kDimension>::GridIndex& index) {
  return find_cell<kDimension>(std::span(lattice.cells), index);
}

template std::optional<std::uint32_t> find_cell<3>(std::span<const Eigen::Vector3i>, const Eigen::Vector3i&);
template std::optional<std::uint32_t> find_cell(const Lattice<2>&, const Eigen::Vector2i&);
template std::optional<std::uint32_t> find_cell(const Lattice<3>&, const Eigen::Vector3i&);

std::optional<PlaceInCell> locate(const Lattice<3>& lattice, const Eigen::Vector3f& position) {
  SC_ASSERT(lattice.spacing > 0, "cells of {} m", lattice.spacing);
  const Vector3d grid =
      (position.cast<double>() - lattice.origin.cast<double>()) / static_cast<double>(lattice.spacing);
  // Far from any lattice, or NaN: return before an index can overflow.
  if (!(grid.cwiseAbs().maxCoeff() <= 2.0 * kMaxLatticeCellsPerAxis)) return std::nullopt;
  const Vector3d low = grid.array().floor();
  Vector3i step;
  for (int d = 0; d < 3; ++d) {
    const double beyond = grid[d] - low[d];
    step[d] = beyond <= kFaceTolerance ? -1 : beyond >= 1 - kFaceTolerance ? 1 : 0;
  }
  for (unsigned choice = 0; choice < 8; ++choice) {
    const Vector3i taken((choice & 1u) ? step.x() : 0, (choice & 2u) ? step.y() : 0,
                         (choice & 4u) ? step.z() : 0);
    const Vector3i index = low.cast<int>() + taken;
    if (const auto cell = find_cell(lattice, index)) {
      return PlaceInCell{*cell, (grid - index.cast<double>()).cwiseMax(0.0).cwiseMin(1.0)};
    }
  }
  return std::nullopt;
}

}  // namespace softcell::ppu
