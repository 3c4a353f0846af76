#pragma once
// The lattice of a soft body: cubic cells that cover the mesh, and particles at the cells' corners.
//
// Convention: cell-vertex. Particles are the corners of occupied cells, so every mesh vertex lies between
// eight particles, skinning is exact for any affine deformation, and no vertex is ever outside the hull of
// its particles.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// Compressed lists: list i is items[offsets[i]] .. items[offsets[i + 1]].
struct Csr {
  std::vector<std::uint32_t> offsets{0};
  std::vector<std::uint32_t> items;

  std::size_t size() const { return offsets.size() - 1; }
  std::span<const std::uint32_t> operator[](std::size_t i) const {
    return {items.data() + offsets[i], items.data() + offsets[i + 1]};
  }
  void push(std::span<const std::uint32_t> list) {
    items.insert(items.end(), list.begin(), list.end());
    offsets.push_back(static_cast<std::uint32_t>(items.size()));
  }
};

/// SPEs step far fewer: a body in tiles takes some 250 bytes of their main memory for each particle.
inline constexpr std::uint32_t kMaxLatticeParticles = 1u << 20;
inline constexpr int kMaxLatticeCellsPerAxis = 256;

struct Lattice {
  float spacing = 0;                ///< edge of a cell in metres
  Eigen::Vector3f origin{0, 0, 0};  ///< position of grid index (0, 0, 0)
  std::vector<Eigen::Vector3i>
      particles;                       ///< grid indices, sorted by x, then y, then z; index = particle number
  std::vector<Eigen::Vector3i> cells;  ///< grid index of each cell's low corner, sorted likewise
  std::vector<std::array<std::uint32_t, 8>>
      corners;              ///< of each cell: particle numbers, corner k = bx + 2 by + 4 bz
  std::vector<float> fill;  ///< of each cell that a triangle touches: the share of its volume inside the
                            ///< mesh, 0.25..1; of all others 1, also in closed cavities
  Csr neighbours;  ///< of each particle: the particles with which it shares a cell, ascending, itself
                   ///< excluded

  Eigen::Vector3f rest_position(std::size_t particle) const {
    return origin + spacing * particles[particle].cast<float>();
  }
};

/// Covers a mesh with cells of edge `cell_size` metres: every cell that a triangle touches, and every cell
/// inside. Deterministic. The surface may have gaps smaller than a cell.
/// @throws std::runtime_error  cell size not positive and finite; so large that one cell holds the whole
/// mesh; so small
///         that the lattice passes kMaxLatticeParticles or kMaxLatticeCellsPerAxis (found before anything is
///         allocated for it); the sentence states the value and what would fit.
Lattice voxelize(const TriangleMesh& mesh, float cell_size);

/// A lattice from cells given by their grid indices (any order, repeats ignored), all with fill 1.
/// @throws std::runtime_error  no cells, or past the limits above.
Lattice lattice_from_cells(std::span<const Eigen::Vector3i> cells, float spacing,
                           const Eigen::Vector3f& origin);

/// Mass of each particle in kg: density (kg/m^3) times the filled volume, an eighth of each cell to each of
/// its corners.
std::vector<float> particle_masses(const Lattice& lattice, float density);

/// Particles that are not surrounded by eight occupied cells: those that collide.
std::vector<bool> outer_particles(const Lattice& lattice);

}  // namespace softcell::ppu
