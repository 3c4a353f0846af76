#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "ppu/lattice/fill_fraction.h"
#include "ppu/lattice/triangle_box.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// How far, in cells, the mesh may stand out of the lattice, or a triangle may miss a cell and still touch it: room for the rounding of
/// float coordinates over kMaxLatticeCellsPerAxis. So a box of ten cells is ten cells long.
constexpr double kHair = 5e-5;

/// In cells: a point that stands out of the grid by more is moved onto its side, as otherwise it would be too far from any cell to touch
/// it. The grid lets the mesh stand out by kHair, and the rounding of its origin may add as much again.
constexpr double kMostOutside = 0.9 * kHair;

std::string metres(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value << " m";
  return text.str();
}

/// The grid that covers the mesh, with the kind of each of its cells.
class Grid {
 public:
  Grid(const Eigen::Vector3f& origin, double spacing, const Vector3i& size)
      : origin_(origin.cast<double>()),
        spacing_(spacing),
        size_(size),
        kinds_(static_cast<std::size_t>(size.x() + 2) * (size.y() + 2) * (size.z() + 2), Kind::kInside) {
    SC_ASSERT(spacing > 0 && size.minCoeff() > 0, "{} x {} x {} cells of {} m", size.x(), size.y(), size.z(),
              spacing);
  }

  Eigen::Vector3f origin() const { return origin_.cast<float>(); }

  /// Marks the cells that the triangle touches.
  void add_surface(const std::array<Vector3d, 3>& corners) {
    std::array<Vector3d, 3> triangle;
    for (int k = 0; k < 3; ++k) triangle[k] = not_outside((corners[k] - origin_) / spacing_);
    Vector3i low, high;
    for (int d = 0; d < 3; ++d) {
      const auto [least, most] = std::minmax({triangle[0][d], triangle[1][d], triangle[2][d]});
      low[d] = std::max(0, static_cast<int>(std::floor(least - kHair)));
      high[d] = std::min(size_[d] - 1, static_cast<int>(std::floor(most + kHair)));
    }
    for (int x = low.x(); x <= high.x(); ++x)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int z = low.z(); z <= high.z(); ++z) {
          Kind& kind = kinds_[number({x, y, z})];
          if (kind != Kind::kSurface &&
              triangle_touches_cube(triangle, Vector3d(x + 0.5, y + 0.5, z + 0.5), 0.5 + kHair))
            kind = Kind::kSurface;
        }
  }

  /// Finds the cells that can be reached from outside through faces of cells, without crossing the surface.
  void flood_outside() {
    std::vector<Vector3i> front{Vector3i(-1, -1, -1)};  // a corner of the layer of padding
    kinds_[number(front.back())] = Kind::kOutside;
    while (!front.empty()) {
      const Vector3i cell = front.back();
      front.pop_back();
      for (int d = 0; d < 3; ++d) {
        for (const int step : {-1, 1}) {
          Vector3i next = cell;
          next[d] += step;
          if (next[d] < -1 || next[d] > size_[d]) continue;
          Kind& kind = kinds_[number(next)];
          if (kind != Kind::kInside) continue;
          kind = Kind::kOutside;
          front.push_back(next);
        }
      }
    }
  }

  std::size_t occupied() const {
    return kinds_.size() - static_cast<std::size_t>(std::count(kinds_.begin(), kinds_.end(), Kind::kOutside));
  }

  /// Occupied cells, sorted by x, then y, then z.
  std::vector<Vector3i> cells() const {
    std::vector<Vector3i> cells;
    cells.reserve(occupied());
    for (int x = 0; x < size_.x(); ++x)
      for (int y = 0; y < size_.y(); ++y)
        for (int z = 0; z < size_.z(); ++z)
          if (kinds_[number({x, y, z})] != Kind::kOutside) cells.emplace_back(x, y, z);
    return cells;
  }

  /// Corners of occupied cells.
  std::size_t particles() const {
    std::size_t count = 0;
    for (int x = 0; x <= size_.x(); ++x)
      for (int y = 0; y <= size_.y(); ++y)
        for (int z = 0; z <= size_.z(); ++z)
          if (touches_occupied({x, y, z})) ++count;
    return count;
  }

  bool is_surface(const Vector3i& cell) const { return kinds_[number(cell)] == Kind::kSurface; }

 private:
  enum class Kind : std::uint8_t { kInside, kSurface, kOutside };

  Vector3d not_outside(Vector3d point) const {
    for (int d = 0; d < 3; ++d) {
      if (point[d] < -kMostOutside) point[d] = 0;
      if (point[d] > size_[d] + kMostOutside) point[d] = size_[d];
    }
    return point;
  }

  /// The index of a cell; its coordinates are -1 to size, as the layer of padding is included.
  std::size_t number(const Vector3i& cell) const {
    SC_ASSERT(cell.minCoeff() >= -1 && (size_ - cell).minCoeff() >= 0, "cell ({}, {}, {}) of {} x {} x {}",
              cell.x(), cell.y(), cell.z(), size_.x(), size_.y(), size_.z());
    return (static_cast<std::size_t>(cell.x() + 1) * (size_.y() + 2) + (cell.y() + 1)) * (size_.z() + 2) +
           (cell.z() + 1);
  }

  bool touches_occupied(const Vector3i& corner) const {
    for (unsigned k = 0; k < 8; ++k)
      if (kinds_[number(corner - Vector3i(k & 1u, (k >> 1u) & 1u, k >> 2u))] != Kind::kOutside) return true;
    return false;
  }

  Vector3d origin_;
  double spacing_;
  Vector3i size_;
  std::vector<Kind> kinds_;
};

/// The number of cells along each axis. @throws if there are too many; the message says why
Vector3i grid_size(const Vector3d& extent, double spacing) {
  const double longest = extent.maxCoeff();
  const Vector3d in_cells = extent / spacing;
  if (in_cells.maxCoeff() > kMaxLatticeCellsPerAxis + kHair)
    throw std::runtime_error("cell size " + metres(spacing) + " is too small: the mesh is " +
                             metres(longest) + " long and may be at most " +
                             std::to_string(kMaxLatticeCellsPerAxis) + " cells long; use " +
                             metres(std::max(longest / kMaxLatticeCellsPerAxis, 1e-30)) + " or more");
  Vector3i size;
  for (int d = 0; d < 3; ++d) size[d] = std::max(1, static_cast<int>(std::ceil(in_cells[d] - 2 * kHair)));
  if (size == Vector3i(1, 1, 1))
    throw std::runtime_error("cell size " + metres(spacing) +
                             " is too large: one cell would hold the whole mesh, which is " +
                             metres(longest) + " long; use less than that");
  return size;
}

/// A float far from 0 is too coarse to tell the cell.
void check_distance(double farthest, double spacing) {
  constexpr double kMostCells = 800;  // its rounding, 2^-24 of it, is kHair
  if (farthest > kMostCells * spacing)
    throw std::runtime_error("the mesh reaches " + metres(farthest) +
                             " from the origin, too far for cells of " + metres(spacing) +
                             "; move it to within " + metres(kMostCells * spacing));
}

void check_particles(std::size_t particles, double spacing) {
  if (particles <= kMaxLatticeParticles<3>) return;
  const double fits = 1.05 * spacing * std::cbrt(static_cast<double>(particles) / kMaxLatticeParticles<3>);
  throw std::runtime_error(
      "cell size " + metres(spacing) + " is too small: the lattice would have more than " +
      std::to_string(kMaxLatticeParticles<3>) + " particles; use about " + metres(fits) + " or more");
}

/// The cells that the mesh occupies. @throws as voxelize() about its arguments
Grid occupied_cells(const TriangleMesh& mesh, float cell_size) {
  const double spacing = static_cast<double>(cell_size);
  if (!(spacing > 0) || !std::isfinite(spacing))
    throw std::runtime_error("cell size " + metres(spacing) + ": expected a positive number of metres");
  if (mesh.positions.empty() || mesh.triangles.empty())
    throw std::runtime_error("the mesh has no triangles; a soft body needs a surface");
  for (const Eigen::Vector3f& position : mesh.positions)
    if (!position.allFinite()) throw std::runtime_error("the mesh has a coordinate that is NaN or infinite");

  const Bounds<3> box = bounds(mesh);
  const Vector3d low = box.low.cast<double>(), high = box.high.cast<double>();
  const Vector3i size = grid_size(high - low, spacing);
  const Vector3d corner = (low + high) / 2 - size.cast<double>() * (spacing / 2);
  check_distance(low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff(), spacing);

  Grid grid(corner.cast<float>(), spacing, size);
  for (const auto& [a, b, c] : mesh.triangles)
    grid.add_surface({mesh.positions[a].cast<double>(), mesh.positions[b].cast<double>(),
                      mesh.positions[c].cast<double>()});
  grid.flood_outside();
  return grid;
}

}  // namespace

std::size_t count_particles(const TriangleMesh& mesh, float cell_size) {
  return occupied_cells(mesh, cell_size).particles();
}

Lattice<3> voxelize(const TriangleMesh& mesh, float cell_size) {
  const double spacing = static_cast<double>(cell_size);
  const Grid grid = occupied_cells(mesh, cell_size);
  check_particles(grid.occupied(), spacing);  // each cell has a low corner of its own
  check_particles(grid.particles(), spacing);

  const std::vector<Vector3i> cells = grid.cells();
  Lattice<3> lattice = lattice_from_cells(cells, cell_size, grid.origin());
  SC_ASSERT(lattice.cells == cells, "a lattice of {} cells from {}, or in another order",
            lattice.cells.size(), cells.size());
  lattice.fill = fill_fractions(mesh, lattice);
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (!grid.is_surface(cells[c])) lattice.fill[c] = 1;
  return lattice;
}

}  // namespace softcell::ppu
