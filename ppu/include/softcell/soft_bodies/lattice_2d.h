#pragma once
// The lattice of a soft body in two dimensions: square cells, and particles at the cells' corners.
//
// The convention of lattice.h: the body is the occupied cells, and everything in it lies between four
// particles.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

inline constexpr std::uint32_t kMaxLattice2dParticles = 65536;

struct Lattice2d {
  float spacing = 0;                       ///< edge of a cell in metres
  Eigen::Vector2f origin{0, 0};            ///< position of grid index (0, 0)
  std::vector<Eigen::Vector2i> particles;  ///< grid indices, sorted by x, then y; index = particle number
  std::vector<Eigen::Vector2i> cells;      ///< grid index of each cell's low corner, sorted likewise
  std::vector<std::array<std::uint32_t, 4>>
      corners;     ///< of each cell: particle numbers, corner k = bx + 2 by
  Csr neighbours;  ///< of each particle: the particles with which it shares a cell, ascending, itself
                   ///< excluded

  Eigen::Vector2f rest_position(std::size_t particle) const {
    return origin + spacing * particles[particle].cast<float>();
  }
};

/// A lattice from cells given by their grid indices (any order, repeats ignored).
/// @throws std::runtime_error  no cells; spacing not positive and finite; more than kMaxLattice2dParticles
/// particles or kMaxLatticeCellsPerAxis cells along an axis.
Lattice2d lattice_2d_from_cells(std::span<const Eigen::Vector2i> cells, float spacing,
                                const Eigen::Vector2f& origin = {0, 0});

/// The cells of a picture in text, one row a string, the top row first: '#' is a cell, '.' and ' ' are none.
/// Row and column of the lower left character are grid index (0, 0).
/// @throws std::runtime_error  any other character: the sentence has its row and column.
std::vector<Eigen::Vector2i> cells_from_rows(std::span<const std::string> rows);

/// Mass of each particle in kg: density (kg/m^2) times the area, a quarter of each cell to each of its
/// corners.
std::vector<float> particle_masses(const Lattice2d& lattice, float density);

/// Particles that are not surrounded by four occupied cells: those that collide.
std::vector<bool> outer_particles(const Lattice2d& lattice);

}  // namespace softcell::ppu
