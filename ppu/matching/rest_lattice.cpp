#include "ppu/matching/rest_lattice.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <tuple>

#include "softcell/base/assert.h"

namespace softcell::ppu {

/// L D L^T of the Laplacian of the edges. A little is added to its diagonal, which a constant in any connected part
/// would else make 0: of a chain of 256 edges the longest wave loses 1e-4 by it.
template <int kDimension>
struct RestLattice<kDimension>::Factor {
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt;
};

template <int kDimension>
RestLattice<kDimension>::RestLattice(const Lattice<kDimension>& lattice)
    : particles_(lattice.particles.size()),
      spacing_(static_cast<double>(lattice.spacing)),
      corners_(lattice.corners) {
  SC_ASSERT(particles_ > 0 && particles_ <= kMaxPlasticParticles, "a plastic body of {} particles",
            particles_);
  const auto each_edge = [&](const auto& visit) {
    for (std::uint32_t cell = 0; cell < corners_.size(); ++cell)
      for (std::uint32_t axis = 0; axis < kDimension; ++axis)
        for (std::uint32_t k = 0, n = 0; k < corners_[cell].size(); ++k)
          if ((k >> axis & 1u) == 0)
            visit(cell, Edge{corners_[cell][k], corners_[cell][k | 1u << axis], axis}, n++);
  };
  each_edge([&](std::uint32_t, const Edge& edge, std::uint32_t) { edges_.push_back(edge); });
  const auto key = [](const Edge& edge) { return std::tie(edge.from, edge.to); };
  const auto before = [&](const Edge& a, const Edge& b) { return key(a) < key(b); };
  std::ranges::sort(edges_, before);
  const auto same = [&](const Edge& a, const Edge& b) { return key(a) == key(b); };
  edges_.erase(std::unique(edges_.begin(), edges_.end(), same), edges_.end());

  edges_of_cell_.resize(corners_.size());
  inverse_cells_.assign(edges_.size(), 0);
  each_edge([&](std::uint32_t cell, const Edge& edge, std::uint32_t n) {
    const auto found = std::ranges::lower_bound(edges_, edge, before);
    const auto number = static_cast<std::uint32_t>(found - edges_.begin());
    edges_of_cell_[cell][edge.axis][n] = number;
    inverse_cells_[number] += 1;
  });
  for (double& cells : inverse_cells_) cells = 1 / cells;

  constexpr double kAnchor = 1e-8;
  std::vector<Eigen::Triplet<double>> entries;
  const auto at = [](std::uint32_t particle) { return static_cast<int>(particle); };
  for (int i = 0; i < static_cast<int>(particles_); ++i) entries.emplace_back(i, i, kAnchor);
  for (const Edge& edge : edges_) {
    entries.emplace_back(at(edge.from), at(edge.from), 1.0);
    entries.emplace_back(at(edge.to), at(edge.to), 1.0);
    entries.emplace_back(std::max(at(edge.from), at(edge.to)), std::min(at(edge.from), at(edge.to)), -1.0);
  }
  const auto size = static_cast<Eigen::Index>(particles_);
  Eigen::SparseMatrix<double> laplacian(size, size);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  auto factor = std::make_unique<Factor>();
  factor->ldlt.compute(laplacian);
  SC_ASSERT(factor->ldlt.info() == Eigen::Success, "the Laplacian of {} edges has no factors", edges_.size());
  factor_ = std::move(factor);
}

template <int kDimension>
RestLattice<kDimension>::~RestLattice() = default;

template <int kDimension>
Eigen::MatrixXd RestLattice<kDimension>::integrate(const Eigen::MatrixXd& wanted) const {
  SC_ASSERT(wanted.rows() == static_cast<Eigen::Index>(edges_.size()), "{} differences along {} edges",
            wanted.rows(), edges_.size());
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(particles_), wanted.cols());
  for (std::size_t l = 0; l < edges_.size(); ++l) {
    const auto row = static_cast<Eigen::Index>(l);
    for (Eigen::Index c = 0; c < wanted.cols(); ++c) {
      sums(edges_[l].from, c) -= wanted(row, c);
      sums(edges_[l].to, c) += wanted(row, c);
    }
  }
  return factor_->ldlt.solve(sums);
}

template class RestLattice<2>;
template class RestLattice<3>;

}  // namespace softcell::ppu
