#pragma once
// The inverse of a small matrix of any scale.

#include <Eigen/Core>
#include <Eigen/LU>

namespace softcell::ppu {

/// The inverse, computed in double precision: in single precision the determinant of a 3 x 3 matrix of masses or inertias is 0 or infinite
/// for bodies of a millimetre or a kilometre.
template <int kRows>
Eigen::Matrix<float, kRows, kRows> wide_inverse(const Eigen::Matrix<float, kRows, kRows>& matrix) {
  if constexpr (kRows == 1)
    return Eigen::Matrix<float, 1, 1>(1 / matrix(0, 0));
  else
    return matrix.template cast<double>().inverse().template cast<float>();
}

}  // namespace softcell::ppu
