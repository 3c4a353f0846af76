#include "ppu/lattice/fill_fraction.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "softcell/base/assert.h"

namespace softcell::ppu {

namespace {

using Eigen::Vector3d;

constexpr int kLines = 4;  // per side: 16 lines in a cell
// Lines avoid the quarters of a cell, where modelled edges are often placed.
constexpr double kOffsetX = 0.4871, kOffsetY = 0.5237;

/// A line passing through the surface; coordinates in cells.
struct Crossing {
  int cell_x, cell_y, line;
  double z;
  int turn;  // +1 into the solid, -1 out of it, going up

  auto key() const { return std::tuple(cell_x, cell_y, line, z, turn); }
  bool operator<(const Crossing& other) const { return key() < other.key(); }
};

/// Which side of the line a -> b, seen from above, the point lies on: +1 left, -1 right, never 0. Exactly
/// opposite for b -> a, so a line through a common edge crosses one of two neighbours.
int side(const Vector3d& a, const Vector3d& b, double x, double y) {
  if (std::tie(b.x(), b.y()) < std::tie(a.x(), a.y())) return -side(b, a, x, y);
  return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x()) >= 0 ? 1 : -1;
}

void find_crossings(const Vector3d (&p)[3], std::vector<Crossing>& crossings) {
  const auto first = [](double low, double offset) {
    return static_cast<int>(std::ceil(low * kLines - offset));
  };
  const auto last = [](double high, double offset) {
    return static_cast<int>(std::floor(high * kLines - offset));
  };
  const auto [low_x, high_x] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
  const auto [low_y, high_y] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
  const double area =
      (p[1].x() - p[0].x()) * (p[2].y() - p[0].y()) - (p[1].y() - p[0].y()) * (p[2].x() - p[0].x());
  if (area == 0) return;  // upright

  for (int i = std::max(0, first(low_x, kOffsetX)); i <= last(high_x, kOffsetX); ++i) {
    for (int j = std::max(0, first(low_y, kOffsetY)); j <= last(high_y, kOffsetY); ++j) {
      const double x = (i + kOffsetX) / kLines, y = (j + kOffsetY) / kLines;
      const int turn = side(p[0], p[1], x, y);
      if (side(p[1], p[2], x, y) != turn || side(p[2], p[0], x, y) != turn) continue;
      const double u =
          ((p[2].y() - p[0].y()) * (x - p[0].x()) - (p[2].x() - p[0].x()) * (y - p[0].y())) / area;
      const double v =
          ((p[1].x() - p[0].x()) * (y - p[0].y()) - (p[1].y() - p[0].y()) * (x - p[0].x())) / area;
      const double z = p[0].z() + u * (p[1].z() - p[0].z()) + v * (p[2].z() - p[0].z());
      // Counter-clockwise from above: the face looks up, and a line going up leaves the solid.
      crossings.push_back({i / kLines, j / kLines, (i % kLines) * kLines + j % kLines, z, -turn});
    }
  }
}

/// Adds the inside parts of one line to the cells that it passes through; false if the line does not end outside.
bool add_inside(std::span<const Crossing> line, std::vector<double>& depth) {
  SC_ASSERT(!depth.empty(), "{} crossings of a column without cells", line.size());
  int winding = 0;
  for (const Crossing& crossing : line) winding += crossing.turn;
  if (winding != 0) return false;
  for (std::size_t c = 0; c + 1 < line.size(); ++c) {
    winding += line[c].turn;
    if (winding == 0) continue;
    const double low = std::max(line[c].z, 0.0),
                 high = std::min(line[c + 1].z, static_cast<double>(depth.size()));
    for (auto cell = static_cast<std::size_t>(low); static_cast<double>(cell) < high; ++cell)
      depth[cell] += std::min(high, static_cast<double>(cell + 1)) - std::max(low, static_cast<double>(cell));
  }
  return true;
}

}  // namespace

std::vector<float> fill_fractions(const TriangleMesh& mesh, const Lattice<3>& lattice) {
  const Vector3d origin = lattice.origin.cast<double>();
  const double spacing = static_cast<double>(lattice.spacing);
  SC_ASSERT(spacing > 0, "cells of {} m", spacing);
  SC_ASSERT(std::ranges::is_sorted(lattice.cells,
                                   [](const auto& a, const auto& b) {
                                     return std::lexicographical_compare(a.begin(), a.end(), b.begin(),
                                                                         b.end());
                                   }),
            "{} cells are not sorted by x, y and z", lattice.cells.size());
  std::vector<Crossing> crossings;
  for (const auto& triangle : mesh.triangles) {
    Vector3d p[3];
    for (int k = 0; k < 3; ++k) p[k] = (mesh.positions[triangle[k]].cast<double>() - origin) / spacing;
    find_crossings(p, crossings);
  }
  std::sort(crossings.begin(), crossings.end());

  // Cells are sorted by x, then y: both lists are walked column by column.
  std::vector<float> fill(lattice.cells.size());
  std::vector<double> depth;
  auto crossing = crossings.cbegin();
  for (std::size_t first = 0, last = 0; first < fill.size(); first = last) {
    const int x = lattice.cells[first].x(), y = lattice.cells[first].y();
    SC_ASSERT(x >= 0 && y >= 0 && lattice.cells[first].z() >= 0, "cell {} has index ({}, {}, {})", first, x,
              y, lattice.cells[first].z());
    while (last < fill.size() && lattice.cells[last].x() == x && lattice.cells[last].y() == y) ++last;
    depth.assign(static_cast<std::size_t>(lattice.cells[last - 1].z()) + 1, 0.0);

    int lines = kLines * kLines;
    while (crossing != crossings.cend() && std::tie(crossing->cell_x, crossing->cell_y) < std::tie(x, y))
      ++crossing;
    while (crossing != crossings.cend() && crossing->cell_x == x && crossing->cell_y == y) {
      const auto end = std::find_if(crossing, crossings.cend(), [&](const Crossing& other) {
        return std::tie(other.cell_x, other.cell_y, other.line) != std::tie(x, y, crossing->line);
      });
      if (!add_inside({crossing, end}, depth)) --lines;
      crossing = end;
    }
    for (std::size_t c = first; c < last; ++c) {
      const double share = lines > 0 ? depth[static_cast<std::size_t>(lattice.cells[c].z())] / lines : 0.5;
      fill[c] = std::clamp(static_cast<float>(share), kLeastFill, 1.0f);
    }
  }
  return fill;
}

}  // namespace softcell::ppu
