#include "softcell/soft_bodies/lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "ppu/lattice/links.h"
#include "ppu/numbers/keep_each_once.h"
#include "ppu/numbers/sorted_lists.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::ppu {

namespace {

template <int kDimension>
using GridIndex = typename Lattice<kDimension>::GridIndex;

/// Orders places by x, then y, then z.
constexpr auto kPrecedes = [](const auto& a, const auto& b) {
  return std::lexicographical_compare(a.data(), a.data() + a.size(), b.data(), b.data() + b.size());
};

template <class Index>
Index corner_of(const Index& cell, unsigned k) {
  Index corner = cell;
  for (int d = 0; d < corner.size(); ++d) corner[d] += static_cast<int>((k >> d) & 1u);
  return corner;
}

// Beyond, a float does not tell corners of a cell apart well.
constexpr int kMostGridIndex = 1'000'000;

template <class Index>
void check_extent(const std::vector<Index>& cells) {
  SC_ASSERT(!cells.empty(), "{} cells have no extent", cells.size());
  for (int d = 0; d < Index::SizeAtCompileTime; ++d) {
    const auto [low, high] = std::minmax_element(cells.begin(), cells.end(),
                                                 [d](const Index& a, const Index& b) { return a[d] < b[d]; });
    for (const int index : {(*low)[d], (*high)[d]})
      if (std::abs(std::int64_t{index}) > kMostGridIndex)
        throw std::runtime_error("a lattice's cells have grid indices of up to " +
                                 std::to_string(kMostGridIndex) + " on both sides of 0; one is " +
                                 std::to_string(index) + " along " + "xyz"[d]);
    const std::int64_t extent = std::int64_t{(*high)[d]} - (*low)[d] + 1;
    if (extent > kMaxLatticeCellsPerAxis)
      throw std::runtime_error("a lattice may be at most " + std::to_string(kMaxLatticeCellsPerAxis) +
                               " cells long; this one has " + std::to_string(extent) + " along " + "xyz"[d]);
  }
}

template <int kDimension>
void check_particles(std::size_t at_least) {
  if (at_least > kMaxLatticeParticles<kDimension>)
    throw std::runtime_error("a lattice may have at most " +
                             std::to_string(kMaxLatticeParticles<kDimension>) +
                             " particles; this one has at least " + std::to_string(at_least));
}

template <int kDimension>
std::vector<GridIndex<kDimension>> distinct_corners(const std::vector<GridIndex<kDimension>>& cells) {
  std::vector<GridIndex<kDimension>> corners;
  corners.reserve(Lattice<kDimension>::kCorners * cells.size());
  for (const GridIndex<kDimension>& cell : cells)
    for (unsigned k = 0; k < Lattice<kDimension>::kCorners; ++k) corners.push_back(corner_of(cell, k));
  keep_each_once(corners, kPrecedes);
  return corners;
}

/// The cells around each particle.
template <int kDimension>
Csr cells_of_particles(const Lattice<kDimension>& lattice) {
  Csr around;
  SC_ASSERT(lattice.corners.size() == lattice.cells.size(), "the corners of {} cells of {}",
            lattice.corners.size(), lattice.cells.size());
  const auto for_each_particle = [&](std::size_t cell, const auto& work) {
    for (const std::uint32_t particle : lattice.corners[cell]) work(particle);
  };
  sort_into_lists(lattice.particles.size(), lattice.corners.size(), for_each_particle, around.offsets,
                  around.items);
  return around;
}

template <int kDimension>
Lattice<kDimension> make_lattice(std::span<const GridIndex<kDimension>> cells, float spacing,
                                 const typename Lattice<kDimension>::Position& origin) {
  if (!(spacing > 0) || !std::isfinite(spacing))
    throw std::runtime_error("lattice spacing " + base::shortest(spacing) + " m: expected a positive number");
  if (!origin.allFinite()) throw std::runtime_error("a lattice has an origin that is NaN or infinite");
  if (cells.empty()) throw std::runtime_error("a lattice needs at least one cell");

  Lattice<kDimension> lattice;
  lattice.spacing = spacing;
  lattice.origin = origin;
  lattice.cells.assign(cells.begin(), cells.end());
  check_extent(lattice.cells);
  keep_each_once(lattice.cells, kPrecedes);
  check_particles<kDimension>(lattice.cells.size());  // each cell has a low corner of its own
  lattice.particles = distinct_corners<kDimension>(lattice.cells);
  check_particles<kDimension>(lattice.particles.size());

  lattice.fill.assign(lattice.cells.size(), 1.0f);
  lattice.corners.resize(lattice.cells.size());
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    for (unsigned k = 0; k < lattice.kCorners; ++k) {
      const auto place = std::lower_bound(lattice.particles.begin(), lattice.particles.end(),
                                          corner_of(lattice.cells[c], k), kPrecedes);
      SC_ASSERT(place != lattice.particles.end() && *place == corner_of(lattice.cells[c], k),
                "corner {} of cell {} is no particle", k, c);
      lattice.corners[c][k] = static_cast<std::uint32_t>(place - lattice.particles.begin());
    }
  }
  lattice.neighbours = find_neighbours(lattice);
  SC_ASSERT(lattice.neighbours.size() == lattice.particles.size(), "the neighbours of {} particles of {}",
            lattice.neighbours.size(), lattice.particles.size());
  return lattice;
}

}  // namespace

template <int kDimension>
Csr find_neighbours(const Lattice<kDimension>& lattice) {
  const Csr around = cells_of_particles(lattice);
  Csr neighbours;
  std::vector<std::uint32_t> list;
  for (std::uint32_t particle = 0; particle < lattice.particles.size(); ++particle) {
    list.clear();
    for (const std::uint32_t cell : around[particle])
      for (const std::uint32_t other : lattice.corners[cell])
        if (other != particle) list.push_back(other);
    keep_each_once(list);
    neighbours.push(list);
  }
  return neighbours;
}

Lattice<3> lattice_from_cells(std::span<const Eigen::Vector3i> cells, float spacing,
                              const Eigen::Vector3f& origin) {
  return make_lattice<3>(cells, spacing, origin);
}

Lattice<2> lattice_from_cells(std::span<const Eigen::Vector2i> cells, float spacing,
                              const Eigen::Vector2f& origin) {
  return make_lattice<2>(cells, spacing, origin);
}

std::vector<Eigen::Vector2i> cells_from_rows(std::span<const std::string> rows) {
  std::vector<Eigen::Vector2i> cells;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t column = 0; column < rows[row].size(); ++column) {
      const char c = rows[row][column];
      if (c == '#') {
        cells.push_back({static_cast<int>(column), static_cast<int>(rows.size() - 1 - row)});
      } else if (c != '.' && c != ' ') {
        throw std::runtime_error(std::string("a lattice's rows are made of '#', '.' and ' '; row ") +
                                 std::to_string(row + 1) + " has '" + c + "' in column " +
                                 std::to_string(column + 1));
      }
    }
  }
  return cells;
}

template <int kDimension>
std::vector<float> particle_masses(const Lattice<kDimension>& lattice, float density) {
  if (!(density > 0) || !std::isfinite(density))
    throw std::invalid_argument("density " + base::shortest(density) +
                                (kDimension == 2 ? " kg/m^2" : " kg/m^3") + ": expected a positive number");
  SC_ASSERT(lattice.fill.size() == lattice.cells.size() && lattice.corners.size() == lattice.cells.size(),
            "{} cells with {} fills and the corners of {}", lattice.cells.size(), lattice.fill.size(),
            lattice.corners.size());
  double mass_of_cell = static_cast<double>(density);
  for (int d = 0; d < kDimension; ++d) mass_of_cell *= static_cast<double>(lattice.spacing);
  const double mass_of_corner = mass_of_cell / static_cast<double>(lattice.kCorners);
  std::vector<double> masses(lattice.particles.size(), 0.0);
  for (std::size_t c = 0; c < lattice.cells.size(); ++c)
    for (const std::uint32_t particle : lattice.corners[c])
      masses[particle] += mass_of_corner * static_cast<double>(lattice.fill[c]);
  return {masses.begin(), masses.end()};
}

template <int kDimension>
std::vector<bool> outer_particles(const Lattice<kDimension>& lattice) {
  const Csr around = cells_of_particles(lattice);
  std::vector<bool> outer(lattice.particles.size());
  for (std::size_t i = 0; i < outer.size(); ++i) outer[i] = around[i].size() < lattice.kCorners;
  return outer;
}

template Csr find_neighbours(const Lattice<2>&);
template Csr find_neighbours(const Lattice<3>&);
template std::vector<float> particle_masses(const Lattice<2>&, float);
template std::vector<float> particle_masses(const Lattice<3>&, float);
template std::vector<bool> outer_particles(const Lattice<2>&);
template std::vector<bool> outer_particles(const Lattice<3>&);

}  // namespace softcell::ppu
