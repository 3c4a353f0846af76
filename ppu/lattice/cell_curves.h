#pragma once
// Maps that move a skin with a lattice in two dimensions, without kinks between cells.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/skin_2d.h"

namespace softcell::ppu {

/// A map from places at rest to present places. It is linear in the positions of particles: each point needs a list of shares, made once.
class SkinMap {
 public:
  virtual ~SkinMap() = default;
  /// Appends the shares that move a point to a skin's lists. @param cell  the number of its nearest cell  @param at  grid coordinates
  virtual void add_vertex(Skin2d& skin, std::uint32_t cell, const Eigen::Vector2f& at) = 0;
};

/// The affine map that fits the particles around a point best, near ones with the greatest weight (moving least squares). It ignores the
/// cells: stairs at a lattice's edge do not show in the skin, not even where something presses on them.
class MeanMap final : public SkinMap {
 public:
  /// @param lattice  with one particle at each grid index; must outlive this map
  explicit MeanMap(const Lattice<2>& lattice);
  void add_vertex(Skin2d& skin, std::uint32_t cell, const Eigen::Vector2f& at) override;

 private:
  const Lattice<2>& lattice_;
  Eigen::Vector2i low_, size_;              // of the particles' grid indices
  std::vector<std::uint32_t> particle_at_;  // rows of y; kNobody
};

/// One cubic patch for each cell, defined by the positions of the cell's particles and the derivatives at the corners. The derivative at a
/// particle is the mean of those along the cells' edges that end there, so neighbouring patches share a tangent. A point outside of the
/// cells is extrapolated along the derivatives at the nearest point of a cell. Several cells that share a particle with the nearest one
/// count in the mean, so that nothing jumps where another cell becomes the nearest.
///
///      h0 = 1 - h1     h1 = 3 t^2 - 2 t^3      g0 = t (1 - t)^2      g1 = -t^2 (1 - t)
class CellCurves final : public SkinMap {
 public:
  /// @param lattice  must outlive this map
  explicit CellCurves(const Lattice<2>& lattice);

  void add_vertex(Skin2d& skin, std::uint32_t cell, const Eigen::Vector2f& at) override;

 private:
  struct Share {
    std::uint32_t particle;
    float share;
  };

  Pull2d& pull_of(std::uint32_t particle);
  void pull_from(std::uint32_t cell, const Eigen::Vector2f& at, float weight);
  float distance(std::uint32_t cell, const Eigen::Vector2f& at) const;

  const Lattice<2>& lattice_;
  // Along x and y, for each particle, of a cell's edge.
  std::array<std::vector<std::vector<Share>>, 2> derivatives_;
  std::vector<std::vector<std::uint32_t>> cells_of_;  // for each particle
  std::vector<std::uint32_t> near_;                   // cells of the current vertex
  std::vector<Pull2d> pulls_;                         // of the current vertex
};

}  // namespace softcell::ppu
