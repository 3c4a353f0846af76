#pragma once
// Places well inside of a body: they tell on which side of something thin a body is whose surface has been pressed through it.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ppu/surfaces/contact_surface.h"
#include "ppu/surfaces/flat_layer.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// A place in a cell of a body.
struct CellPlace {
  std::uint32_t cell = 0;
  Eigen::Vector3f xi{0, 0, 0};  ///< 0..1 along each edge of the cell
};

/// Of each cell the deepest of the field's nodes in it and in the cells beside it.
std::vector<CellPlace> find_inner_places(const ContactSurface& surface, const Lattice<3>& lattice);
/// Of a flat layer: in the body's own cells, and in the plane. What a margin cell has is that of the cell beside which it moves.
std::vector<CellPlace> find_inner_places(const FlatLayer& layer);

/// Which of some cells has a place: in cells, from the lattice's grid index 0. @param cells  ascending, as a lattice has them
std::optional<std::uint32_t> cell_at(std::span<const Eigen::Vector3i> cells, const Eigen::Vector3f& place);

}  // namespace softcell::ppu
