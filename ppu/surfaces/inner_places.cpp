#include "ppu/surfaces/inner_places.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

#include "ppu/lattice/locate.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

using Eigen::Vector3f;
using Eigen::Vector3i;

namespace {

/// @param cells  the first ones of the surface
std::vector<CellPlace> deepest_nodes(const ContactSurface& surface, std::span<const Vector3i> cells) {
  std::vector<CellPlace> places(cells.size());
  for (std::uint32_t cell = 0; cell < places.size(); ++cell) {
    float deepest = std::numeric_limits<float>::max();
    const auto look_at = [&](std::uint32_t other) {
      const ContactSurface::CellField& nodes = surface.nodes(other);
      const auto lowest = std::min_element(nodes.begin(), nodes.end());
      if (*lowest >= deepest) return;
      deepest = *lowest;
      places[cell] = {other, ContactSurface::place_of_node(static_cast<std::size_t>(lowest - nodes.begin()))};
    };
    look_at(cell);
    for (int d = 0; d < 6; ++d) {
      const Vector3i beside = (d < 3 ? 1 : -1) * Vector3i(Vector3i::Unit(d % 3));
      if (const auto other = find_cell<3>(cells, cells[cell] + beside)) look_at(*other);
    }
  }
  return places;
}

/// If a part is thinner than the distance between nodes, all nodes may be outside of it: then the middle of the cell's surface points is
/// used.
void replace_those_outside(const ContactSurface& surface, std::vector<CellPlace>& places) {
  auto point = surface.points().begin();  // ascending by cell
  for (std::uint32_t cell = 0; cell < places.size(); ++cell) {
    Vector3f sum = Vector3f::Zero();
    int own = 0;
    for (; point != surface.points().end() && point->cell == cell; ++point, ++own) sum += point->xi;
    const bool is_inside = surface.field(places[cell].cell, places[cell].xi).distance < 0;
    if (!is_inside && own > 0) places[cell] = {cell, sum / static_cast<float>(own)};
  }
}

}  // namespace

std::vector<CellPlace> find_inner_places(const ContactSurface& surface, const Lattice<3>& lattice) {
  std::vector<CellPlace> places = deepest_nodes(surface, lattice.cells);
  replace_those_outside(surface, places);
  return places;
}

std::vector<CellPlace> find_inner_places(const FlatLayer& layer) {
  const std::span<const MarginCell> cells = layer.margin_cells();
  const std::size_t own = layer.own_cells();
  std::vector<CellPlace> places =
      deepest_nodes(layer.surface(), std::span(layer.lattice()->cells).first(own));
  for (CellPlace& place : places) place.xi.z() = 0.5f;  // in the plane, where points are
  for (std::size_t margin = own; margin < cells.size(); ++margin)
    places.push_back(CellPlace(places[cells[margin].beside]));
  return places;
}

std::optional<std::uint32_t> cell_at(std::span<const Vector3i> cells, const Vector3f& place) {
  SC_ASSERT(place.allFinite(), "place {} in the lattice", place.x());
  return find_cell<3>(cells, place.array().floor().cast<int>());
}

}  // namespace softcell::ppu
