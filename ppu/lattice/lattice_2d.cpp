#include "softcell/soft_bodies/lattice_2d.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>

namespace softcell::ppu {
namespace {

using Eigen::Vector2i;

bool precedes(const Vector2i& a, const Vector2i& b) {
  return std::make_tuple(a.x(), a.y()) < std::make_tuple(b.x(), b.y());
}

Vector2i corner_of(const Vector2i& cell, unsigned k) { return cell + Vector2i(k & 1u, k >> 1u); }

void check_extent(const std::vector<Vector2i>& cells) {
  for (int d = 0; d < 2; ++d) {
    const auto [low, high] = std::minmax_element(
        cells.begin(), cells.end(), [d](const Vector2i& a, const Vector2i& b) { return a[d] < b[d]; });
    const std::int64_t extent = std::int64_t{(*high)[d]} - (*low)[d] + 1;
    if (extent > kMaxLatticeCellsPerAxis) {
      throw std::runtime_error("a lattice may be at most " + std::to_string(kMaxLatticeCellsPerAxis) +
                               " cells long; this one has " + std::to_string(extent) + " along " + "xy"[d]);
    }
  }
}

void sort_and_unite(std::vector<Vector2i>& points) {
  std::sort(points.begin(), points.end(), precedes);
  points.erase(std::unique(points.begin(), points.end()), points.end());
}

Csr find_neighbours(const Lattice2d& lattice) {
  std::vector<std::vector<std::uint32_t>> lists(lattice.particles.size());
  for (const auto& cell : lattice.corners) {
    for (const std::uint32_t a : cell) {
      for (const std::uint32_t b : cell) {
        if (a != b) lists[a].push_back(b);
      }
    }
  }
  Csr neighbours;
  for (std::vector<std::uint32_t>& list : lists) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    neighbours.push(list);
  }
  return neighbours;
}

}  // namespace

Lattice2d lattice_2d_from_cells(std::span<const Vector2i> cells, float spacing,
                                const Eigen::Vector2f& origin) {
  if (!(spacing > 0) || !std::isfinite(spacing)) {
    throw std::runtime_error("lattice spacing " + std::to_string(spacing) + " m: expected a positive number");
  }
  if (cells.empty()) throw std::runtime_error("a lattice needs at least one cell");
  Lattice2d lattice;
  lattice.spacing = spacing;
  lattice.origin = origin;
  lattice.cells.assign(cells.begin(), cells.end());
  check_extent(lattice.cells);
  sort_and_unite(lattice.cells);
  for (const Vector2i& cell : lattice.cells) {
    for (unsigned k = 0; k < 4; ++k) lattice.particles.push_back(corner_of(cell, k));
  }
  sort_and_unite(lattice.particles);
  if (lattice.particles.size() > kMaxLattice2dParticles) {
    throw std::runtime_error("a lattice may have at most " + std::to_string(kMaxLattice2dParticles) +
                             " particles; this one has " + std::to_string(lattice.particles.size()));
  }
  for (const Vector2i& cell : lattice.cells) {
    auto& corners = lattice.corners.emplace_back();
    for (unsigned k = 0; k < 4; ++k) {
      const auto place =
          std::lower_bound(lattice.particles.begin(), lattice.particles.end(), corner_of(cell, k), precedes);
      corners[k] = static_cast<std::uint32_t>(place - lattice.particles.begin());
    }
  }
  lattice.neighbours = find_neighbours(lattice);
  return lattice;
}

std::vector<Vector2i> cells_from_rows(std::span<const std::string> rows) {
  std::vector<Vector2i> cells;
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

std::vector<float> particle_masses(const Lattice2d& lattice, float density) {
  if (!(density > 0) || !std::isfinite(density)) {
    throw std::invalid_argument("density " + std::to_string(density) + " kg/m^2: expected a positive number");
  }
  const double s = static_cast<double>(lattice.spacing);
  const double mass_of_corner = static_cast<double>(density) * s * s / 4;
  std::vector<double> masses(lattice.particles.size(), 0.0);
  for (const auto& cell : lattice.corners) {
    for (const std::uint32_t particle : cell) masses[particle] += mass_of_corner;
  }
  return {masses.begin(), masses.end()};
}

std::vector<bool> outer_particles(const Lattice2d& lattice) {
  std::vector<int> cells(lattice.particles.size(), 0);
  for (const auto& cell : lattice.corners) {
    for (const std::uint32_t particle : cell) ++cells[particle];
  }
  std::vector<bool> outer(cells.size());
  for (std::size_t i = 0; i < outer.size(); ++i) outer[i] = cells[i] < 4;
  return outer;
}

}  // namespace softcell::ppu
