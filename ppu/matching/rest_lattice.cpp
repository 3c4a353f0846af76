#include "ppu/matching/rest_lattice.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <tuple>

#include "softcell/base/assert.h"

namespace softcell::ppu {

/// L D L^T of the Laplacian of the edges, in an order that leaves L sparse. A little is added to the diagonal; without it, a constant in a
/// connected part would make an element of D 0. In a chain of 256 edges the longest wave loses 1e-4 by that.
///
/// Eigen solves for one column after the other; here the columns lie side by side, and L is read once.
template <int kDimension>
struct RestLattice<kDimension>::Factor {
  struct Entry {
    double value;
    std::uint32_t row;
  };
  std::vector<std::uint32_t> place_of;      // of each particle
  std::vector<std::uint32_t> first_entry;   // of each column of L, below its diagonal of ones; and the end
  std::vector<Entry> entries;               // column by column
  std::vector<double> inverse_of_diagonal;  // of D

  explicit Factor(const Eigen::SparseMatrix<double>& laplacian) {
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(laplacian);
    SC_ASSERT(ldlt.info() == Eigen::Success, "the Laplacian of {} particles has no factors",
              laplacian.rows());
    const Eigen::SparseMatrix<double> lower = ldlt.matrixL();
    for (Eigen::Index column = 0; column < lower.cols(); ++column) {
      place_of.push_back(static_cast<std::uint32_t>(ldlt.permutationP().indices()[column]));
      inverse_of_diagonal.push_back(1 / ldlt.vectorD()[column]);
      first_entry.push_back(static_cast<std::uint32_t>(entries.size()));
      for (Eigen::SparseMatrix<double>::InnerIterator entry(lower, column); entry; ++entry)
        if (entry.row() > column) entries.push_back({entry.value(), static_cast<std::uint32_t>(entry.row())});
    }
    first_entry.push_back(static_cast<std::uint32_t>(entries.size()));
  }

  /// @param x  by place; in: the right side, out: the solution
  template <typename Row>
  void solve(std::vector<Row>& x) const {
    for (std::size_t column = 0; column < x.size(); ++column) {
      const Row at = x[column];
      for (std::uint32_t k = first_entry[column]; k < first_entry[column + 1]; ++k)
        x[entries[k].row] -= entries[k].value * at;
      x[column] *= inverse_of_diagonal[column];
    }
    for (std::size_t column = x.size(); column-- > 0;) {
      Row at = x[column];
      for (std::uint32_t k = first_entry[column]; k < first_entry[column + 1]; ++k)
        at -= entries[k].value * x[entries[k].row];
      x[column] = at;
    }
  }
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
  factor_ = std::make_unique<const Factor>(laplacian);
}

template <int kDimension>
RestLattice<kDimension>::~RestLattice() = default;

template <int kDimension>
template <int kNumbers>
auto RestLattice<kDimension>::integrate(const Values<kNumbers>& wanted) const -> Values<kNumbers> {
  SC_ASSERT(wanted.size() == edges_.size(), "{} differences along {} edges", wanted.size(), edges_.size());
  using Row = Eigen::Matrix<double, kNumbers == 3 ? 4 : kNumbers, 1>;  // whole vector registers of the host
  std::vector<Row> sums(particles_, Row::Zero());
  for (std::size_t l = 0; l < edges_.size(); ++l) {
    sums[factor_->place_of[edges_[l].from]].template head<kNumbers>() -= wanted[l];
    sums[factor_->place_of[edges_[l].to]].template head<kNumbers>() += wanted[l];
  }
  factor_->solve(sums);
  Values<kNumbers> values;
  for (const std::uint32_t place : factor_->place_of) values.push_back(sums[place].template head<kNumbers>());
  return values;
}

template class RestLattice<2>;
template class RestLattice<3>;
template RestLattice<2>::Values<1> RestLattice<2>::integrate(const Values<1>&) const;
template RestLattice<2>::Values<2> RestLattice<2>::integrate(const Values<2>&) const;
template RestLattice<3>::Values<3> RestLattice<3>::integrate(const Values<3>&) const;

}  // namespace softcell::ppu
