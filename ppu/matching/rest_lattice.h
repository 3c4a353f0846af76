#pragma once
// Data that plastic bodies of one lattice share: its edges along the axes, and the equations that determine a rest shape.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// The most particles of a plastic body: solving for a rest shape of this size takes some 4 ms.
inline constexpr std::uint32_t kMaxPlasticParticles = 4096;

/// Immutable; any thread may read it.
/// @tparam kDimension  2 or 3
template <int kDimension>
class RestLattice {
 public:
  /// Edges of a cell along one axis.
  static constexpr std::size_t kEdgesPerAxis = std::size_t{1} << (kDimension - 1);
  /// An edge of one or more cells. In the lattice, `to` is one step further along `axis` than `from`.
  struct Edge {
    std::uint32_t from, to;
    std::uint32_t axis;
  };
  using EdgesOfCell = std::array<std::array<std::uint32_t, kEdgesPerAxis>, kDimension>;  ///< by axis

  /// @pre at most kMaxPlasticParticles particles
  explicit RestLattice(const Lattice<kDimension>& lattice);
  ~RestLattice();

  std::span<const Edge> edges() const { return edges_; }
  std::span<const EdgesOfCell> edges_of_cell() const { return edges_of_cell_; }
  /// 1 / the number of cells that have the edge.
  std::span<const double> inverse_cells() const { return inverse_cells_; }
  std::size_t particles() const { return particles_; }
  double spacing() const { return spacing_; }  ///< metres
  const std::vector<std::array<std::uint32_t, Lattice<kDimension>::kCorners>>& corners() const {
    return corners_;
  }

  /// Calls visit(a, b) for pairs of particles whose distance measures strain: the ends of edges, then opposite corners of cells.
  template <typename Visit>
  void each_length(const Visit& visit) const {
    for (const Edge& edge : edges_) visit(edge.from, edge.to);
    constexpr std::uint32_t kLast = Lattice<kDimension>::kCorners - 1;
    for (const auto& corners : corners_)
      for (std::uint32_t k = 0; 2 * k < kLast; ++k) visit(corners[k], corners[kLast - k]);
  }
  /// The number of pairs that each_length() visits.
  std::size_t lengths() const { return edges_.size() + corners_.size() * Lattice<kDimension>::kCorners / 2; }

  /// The values at particles whose differences along the edges are nearest to the wanted ones: least squares of u_to - u_from - wanted. Of
  /// all solutions, the one whose mean is 0 in each connected part.
  /// @param wanted  for each edge    @return for each particle
  template <int kNumbers>
  using Values = std::vector<Eigen::Matrix<double, kNumbers, 1>>;
  template <int kNumbers>
  Values<kNumbers> integrate(const Values<kNumbers>& wanted) const;

 private:
  struct Factor;

  std::size_t particles_;
  double spacing_;
  std::vector<Edge> edges_;
  std::vector<EdgesOfCell> edges_of_cell_;
  std::vector<double> inverse_cells_;
  std::vector<std::array<std::uint32_t, Lattice<kDimension>::kCorners>> corners_;
  std::unique_ptr<const Factor> factor_;
};

extern template class RestLattice<2>;
extern template class RestLattice<3>;
extern template RestLattice<2>::Values<1> RestLattice<2>::integrate(const Values<1>&) const;
extern template RestLattice<2>::Values<2> RestLattice<2>::integrate(const Values<2>&) const;
extern template RestLattice<3>::Values<3> RestLattice<3>::integrate(const Values<3>&) const;

}  // namespace softcell::ppu
