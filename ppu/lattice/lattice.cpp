#include "softcell/soft_bodies/lattice.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>

namespace softcell::ppu {

namespace {

using Eigen::Vector3i;

bool precedes(const Vector3i& a, const Vector3i& b) {
  return std::make_tuple(a.x(), a.y(), a.z()) < std::make_tuple(b.x(), b.y(), b.z());
}

Vector3i corner_of(const Vector3i& cell, unsigned k) {
  return cell + Vector3i(k & 1u, (k >> 1u) & 1u, (k >> 2u) & 1u);
}

void check_extent(const std::vector<Vector3i>& cells) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (int d = 0; d < 3; ++d) {
    const auto [low, high] = std::minmax_element(
        cells.begin(), cells.end(), [d](const Vector3i& a, const Vector3i& b) { return a[d] < b[d]; });
    const std::int64_t extent = std::int64_t{(*high)[d]} - (*low)[d] + 1;
    if (extent > kMaxLatticeCellsPerAxis)
      throw std::runtime_error("a lattice may be at most " + std::to_string(kMaxLatticeCellsPerAxis) +
                               " cells long; this one has " + std::to_string(extent) + " along " + kAxes[d]);
  }
}

void check_particles(std::size_t at_least) {
  if (at_least > kMaxLatticeParticles)
    throw std::runtime_error("a lattice may have at most " + std::to_string(kMaxLatticeParticles) +
                             " particles; this one has at least " + std::to_string(at_least));
}

std::vector<Vector3i> distinct_corners(const std::vector<Vector3i>& cells) {
  std::vector<Vector3i> corners;
  corners.reserve(8 * cells.size());
  for (const Vector3i& cell : cells)
    for (unsigned k = 0; k < 8; ++k) corners.push_back(corner_of(cell, k));
  std::sort(corners.begin(), corners.end(), precedes);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// The cells around each particle.
Csr cells_of_particles(const Lattice& lattice) {
  Csr around;
  around.offsets.assign(lattice.particles.size() + 1, 0);
  for (const auto& corners : lattice.corners)
    for (const std::uint32_t particle : corners) ++around.offsets[particle + 1];
  for (std::size_t i = 1; i < around.offsets.size(); ++i) around.offsets[i] += around.offsets[i - 1];
  around.items.resize(around.offsets.back());
  std::vector<std::uint32_t> next(around.offsets.begin(), around.offsets.end() - 1);
  for (std::uint32_t cell = 0; cell < lattice.corners.size(); ++cell)
    for (const std::uint32_t particle : lattice.corners[cell]) around.items[next[particle]++] = cell;
  return around;
}

Csr find_neighbours(const Lattice& lattice) {
  const Csr around = cells_of_particles(lattice);
  Csr neighbours;
  std::vector<std::uint32_t> list;
  for (std::uint32_t particle = 0; particle < lattice.particles.size(); ++particle) {
    list.clear();
    for (const std::uint32_t cell : around[particle])
      for (const std::uint32_t other : lattice.corners[cell])
        if (other != particle) list.push_back(other);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    neighbours.push(list);
  }
  return neighbours;
}

}  // namespace

Lattice lattice_from_cells(std::span<const Vector3i> cells, float spacing, const Eigen::Vector3f& origin) {
  if (!(spacing > 0) || !std::isfinite(spacing))
    throw std::runtime_error("lattice spacing " + std::to_string(spacing) + " m: expected a positive number");
  if (cells.empty()) throw std::runtime_error("a lattice needs at least one cell");

  Lattice lattice;
  lattice.spacing = spacing;
  lattice.origin = origin;
  lattice.cells.assign(cells.begin(), cells.end());
  check_extent(lattice.cells);
  std::sort(lattice.cells.begin(), lattice.cells.end(), precedes);
  lattice.cells.erase(std::unique(lattice.cells.begin(), lattice.cells.end()), lattice.cells.end());
  check_particles(lattice.cells.size());  // each cell has a low corner of its own
  lattice.particles = distinct_corners(lattice.cells);
  check_particles(lattice.particles.size());

  lattice.fill.assign(lattice.cells.size(), 1.0f);
  lattice.corners.resize(lattice.cells.size());
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    for (unsigned k = 0; k < 8; ++k) {
      const auto place = std::lower_bound(lattice.particles.begin(), lattice.particles.end(),
                                          corner_of(lattice.cells[c], k), precedes);
      lattice.corners[c][k] = static_cast<std::uint32_t>(place - lattice.particles.begin());
    }
  }
  lattice.neighbours = find_neighbours(lattice);
  return lattice;
}

std::vector<float> particle_masses(const Lattice& lattice, float density) {
  if (!(density > 0) || !std::isfinite(density))
    throw std::invalid_argument("density " + std::to_string(density) + " kg/m^3: expected a positive number");
  const double s = static_cast<double>(lattice.spacing);
  const double mass_of_corner = static_cast<double>(density) * s * s * s / 8;
  std::vector<double> masses(lattice.particles.size(), 0.0);
  for (std::size_t c = 0; c < lattice.cells.size(); ++c)
    for (const std::uint32_t particle : lattice.corners[c])
      masses[particle] += mass_of_corner * static_cast<double>(lattice.fill[c]);
  return {masses.begin(), masses.end()};
}

std::vector<bool> outer_particles(const Lattice& lattice) {
  const Csr around = cells_of_particles(lattice);
  std::vector<bool> outer(lattice.particles.size());
  for (std::size_t i = 0; i < outer.size(); ++i) outer[i] = around[i].size() < 8;
  return outer;
}

}  // namespace softcell::ppu
