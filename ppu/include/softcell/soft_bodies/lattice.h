#pragma once
// The lattice of a soft body: cells that cover it, squares in two dimensions and cubes in three, and
// particles at the cells' corners.
//
// Convention: cell-vertex. Particles are the corners of occupied cells, so everything in the body lies
// between the corners of one cell, skinning is exact for any affine deformation, and no mesh vertex is ever
// outside the hull of its particles.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// Compressed lists: list i is items[offsets[i]] .. items[offsets[i + 1]].
struct Csr {
  std::vector<std::uint32_t> offsets{0};
  std::vector<std::uint32_t> items;

  std::size_t size() const { return offsets.size() - 1; }  ///< number of lists
  /// List i. Valid until push().
  std::span<const std::uint32_t> operator[](std::size_t i) const {
    return {items.data() + offsets[i], items.data() + offsets[i + 1]};
  }
  /// Appends a list.
  void push(std::span<const std::uint32_t> list) {
    items.insert(items.end(), list.begin(), list.end());
    offsets.push_back(static_cast<std::uint32_t>(items.size()));
  }
};

/// The most particles of a lattice. Main memory may hold fewer: a body that is stepped in tiles takes some 250 bytes of
/// it for each particle.
template <int kDimension>
inline constexpr std::uint32_t kMaxLatticeParticles = kDimension == 2 ? 1u << 16 : 1u << 20;
/// The most cells of a lattice along an axis.
inline constexpr int kMaxLatticeCellsPerAxis = 256;

/// Cells and particles at rest. The functions below make lattices; the arrays fit each other only as these make them.
/// @tparam kDimension  2 or 3
template <int kDimension>
struct Lattice {
  static_assert(kDimension == 2 || kDimension == 3);
  static constexpr std::size_t kCorners = std::size_t{1} << kDimension;  ///< of a cell
  using Position = Eigen::Vector<float, kDimension>;
  using GridIndex = Eigen::Vector<int, kDimension>;

  float spacing = 0;                   ///< edge of a cell in metres
  Position origin = Position::Zero();  ///< position of grid index 0, metres
  std::vector<GridIndex> particles;    ///< sorted by x, then y, then z; index = particle number
  std::vector<GridIndex> cells;        ///< of each cell's low corner, sorted likewise
  /// For each cell, the numbers of its particles, corner k = bx + 2 by + 4 bz.
  std::vector<std::array<std::uint32_t, kCorners>> corners;
  /// For each cell that a triangle touches: the share of its volume inside the mesh, 0.25..1. For all other cells 1,
  /// also in closed cavities; in two dimensions 1 for all cells.
  std::vector<float> fill;
  /// For each particle: the other particles with which it shares a cell, ascending.
  Csr neighbours;

  /// Metres, in the lattice's frame.
  Position rest_position(std::size_t particle) const {
    return origin + spacing * particles[particle].template cast<float>();
  }
};

/// Covers a mesh with cells of edge `cell_size` metres: every cell that a triangle touches, and every cell
/// inside. Deterministic. The surface may have gaps smaller than a cell.
/// @throws std::runtime_error  a mesh without triangles, with a coordinate that is NaN or infinite, or too far from the origin for
///         floats to tell its cells; cell size not positive and finite; so large that one cell holds the whole
///         mesh; so small that the lattice passes kMaxLatticeParticles or kMaxLatticeCellsPerAxis (found
///         before anything is allocated for it); the message states the value and what would fit.
Lattice<3> voxelize(const TriangleMesh& mesh, float cell_size);

/// The number of particles that voxelize() would make, found without making the lattice; it may exceed kMaxLatticeParticles.
/// @throws std::runtime_error  as voxelize(), for all other reasons
std::size_t count_particles(const TriangleMesh& mesh, float cell_size);

/// A lattice from cells given by their grid indices (any order, repeats ignored), all with fill 1.
/// @param spacing  edge of a cell, metres
/// @param origin   position of grid index 0, metres
/// @throws std::runtime_error  no cells; a grid index above 1,000,000 or below -1,000,000; spacing not positive and finite; an
///         origin that is not finite; more than kMaxLatticeParticles particles or kMaxLatticeCellsPerAxis cells along an axis.
Lattice<3> lattice_from_cells(std::span<const Eigen::Vector3i> cells, float spacing,
                              const Eigen::Vector3f& origin = Eigen::Vector3f::Zero());
Lattice<2> lattice_from_cells(std::span<const Eigen::Vector2i> cells, float spacing,
                              const Eigen::Vector2f& origin = Eigen::Vector2f::Zero());

/// The cells of a picture in text, one string per row, the top row first: '#' is a cell, '.' and ' ' are empty.
/// Row and column of the lower left character are grid index (0, 0).
/// @throws std::runtime_error  any other character: the message gives its row and column.
std::vector<Eigen::Vector2i> cells_from_rows(std::span<const std::string> rows);

/// Mass of each particle in kg: density (kg/m^3, in two dimensions kg/m^2) times the filled volume (area);
/// each cell gives equal shares to its corners.
/// @throws std::invalid_argument  density not positive and finite.
/// @pre the lattice has one fill and one set of corners for each cell
template <int kDimension>
std::vector<float> particle_masses(const Lattice<kDimension>& lattice, float density);

/// For each particle, whether it lies at the lattice's boundary: fewer than four cells (in three dimensions eight) have it as a corner.
template <int kDimension>
std::vector<bool> outer_particles(const Lattice<kDimension>& lattice);

}  // namespace softcell::ppu
