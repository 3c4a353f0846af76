#pragma once
// Solves equations whose matrix is symmetric, positive definite, and zero far from its diagonal.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace softcell::ppu {

/// The Cholesky factor of such a matrix, in doubles. Used by one thread. Allocates when a matrix is larger than ever before.
class SkylineFactor {
 public:
  /// @param first    first(i): row i is zero before this column
  /// @param element  element(i, j), for j from first(i) to i
  /// @param least    least(i): replaces a smaller pivot, which comes from a row that depends on earlier ones
  template <class First, class Element, class Least>
  void factor(std::size_t n, const First& first, const Element& element, const Least& least) {
    n_ = n;
    first_.resize(n);
    lower_.assign(n * n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      first_[i] = first(i);
      double* const row = &lower_[i * n];
      for (std::size_t j = first_[i]; j <= i; ++j) {
        const double* const other = &lower_[j * n];
        double sum = element(i, j);
        for (std::size_t k = std::max(first_[i], first_[j]); k < j; ++k) sum -= row[k] * other[k];
        row[j] = i == j ? std::sqrt(std::max(sum, least(i))) : sum / other[j];
      }
    }
  }

  /// Replaces the right sides by the solutions. @pre as many values as rows
  void solve(std::span<double> values) const {
    for (std::size_t i = 0; i < n_; ++i) {
      const double* const row = &lower_[i * n_];
      for (std::size_t k = first_[i]; k < i; ++k) values[i] -= row[k] * values[k];
      values[i] /= row[i];
    }
    for (std::size_t i = n_; i-- > 0;) {
      const double* const row = &lower_[i * n_];
      values[i] /= row[i];
      for (std::size_t k = first_[i]; k < i; ++k) values[k] -= row[k] * values[i];
    }
  }

 private:
  std::size_t n_ = 0;
  std::vector<std::size_t> first_;
  std::vector<double> lower_;  // row by row
};

}  // namespace softcell::ppu
