#pragma once
// Small lattices of every awkward kind, and numbers to shake them with. Shared by the tests of the soft
// body's mathematics.

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu::test {

/// A linear congruential generator: the same numbers on every host.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 2654435761u + 1) {}
  /// Uniform in -1..1.
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) * 0x1p-52 - 1.0;
  }
  Eigen::Vector3d vector() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }
  Eigen::Quaterniond rotation() {
    const double w = next(), x = next(), y = next(), z = next();
    return Eigen::Quaterniond(w, x, y, z).normalized();
  }

 private:
  std::uint64_t state_;
};

struct NamedLattice {
  std::string name;
  Lattice<3> lattice;
};

inline std::vector<Eigen::Vector3i> cells_where(const Eigen::Vector3i& size,
                                                const std::function<bool(int, int, int)>& inside) {
  std::vector<Eigen::Vector3i> cells;
  for (int x = 0; x < size.x(); ++x)
    for (int y = 0; y < size.y(); ++y)
      for (int z = 0; z < size.z(); ++z)
        if (inside(x, y, z)) cells.emplace_back(x, y, z);
  return cells;
}

inline std::vector<Eigen::Vector3i> block_cells(int x, int y, int z) {
  return cells_where({x, y, z}, [](int, int, int) { return true; });
}

inline Lattice<3> block(int x, int y, int z, float spacing = 0.1f) {
  return lattice_from_cells(block_cells(x, y, z), spacing, {0, 0, 0});
}

/// Two legs of `length` cells with a gap one cell wide between them, joined at one end. One cell thick.
inline std::vector<Eigen::Vector3i> horseshoe_cells(int length) {
  return cells_where({length, 3, 1}, [](int x, int y, int) { return x == 0 || y != 1; });
}

/// Cells of every lattice below; 0.1 m each.
inline std::vector<std::pair<std::string, std::vector<Eigen::Vector3i>>> all_cells() {
  const auto square = [](double v) { return v * v; };
  return {
      {"block", block_cells(5, 4, 3)},
      {"sphere",
       cells_where({7, 7, 7},
                   [&](int x, int y, int z) { return square(x - 3) + square(y - 3) + square(z - 3) < 11; })},
      {"torus", cells_where({9, 9, 3},
                            [&](int x, int y, int z) {
                              const double ring = std::sqrt(square(x - 4) + square(y - 4)) - 3;
                              return square(ring) + square(z - 1) < 1.5;
                            })},
      {"sheet", block_cells(8, 7, 1)},
      {"row", block_cells(9, 1, 1)},
      {"touching at an edge", {{0, 0, 0}, {1, 1, 0}}},
      {"touching at a corner", {{0, 0, 0}, {1, 1, 1}}},
      {"disconnected", cells_where({7, 2, 2}, [](int x, int, int) { return x != 3; })},
      {"horseshoe", horseshoe_cells(6)},
      {"one cell", {{0, 0, 0}}},
  };
}

inline std::vector<NamedLattice> all_lattices() {
  std::vector<NamedLattice> lattices;
  for (const auto& [name, cells] : all_cells())
    lattices.push_back({name, lattice_from_cells(cells, 0.1f, {-0.2f, 0.3f, 0.1f})});
  return lattices;
}

}  // namespace softcell::ppu::test
