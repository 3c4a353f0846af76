#pragma once
// Finds places well inside of a body. They tell on which side of a thin obstacle a body is when its surface has been pressed through it.

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

/// For each cell: the deepest of the field's nodes in it and in the cells beside it.
std::vector<CellPlace> find_inner_places(const ContactSurface& surface, const Lattice<3>& lattice);
/// The same for a flat layer: only in the body's own cells, and in the plane. A margin cell gets the place of the cell that it moves with.
std::vector<CellPlace> find_inner_places(const FlatLayer& layer);

/// The cell, of these, that contains a place given in cells from the lattice's grid index 0. @param cells  ascending, as a lattice has them
std::optional<std::uint32_t> cell_at(std::span<const Eigen::Vector3i> cells, const Eigen::Vector3f& place);

}  // namespace softcell::ppu
