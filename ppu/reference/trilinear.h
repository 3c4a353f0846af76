#pragma once
// The trilinear map of one lattice cell, in float or double; corner k = bx + 2 by + 4 bz.  [LSM07, embedding]
//
//   N_k      = prod_d (b_d ? xi_d : 1 - xi_d)                            weights; they sum to 1
//   dN_k/dxi_d = (b_d ? +1 : -1) prod_{e != d} (b_e ? xi_e : 1 - xi_e)     gradient, in units of the cell's
//   edge x = sum_k N_k x_k        F = sum_k x_k (grad N_k)^T                  position, deformation gradient
//   times the edge n ~ cof(F) N = N_x (f2 x f3) + N_y (f3 x f1) + N_z (f1 x f2)         f_i the columns of F

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace softcell::ppu {

/// The least |cof(F) N|^2 in m^4: below it the cell is flat and says nothing about the normal. The kernel `skin` has
/// no bound: it adds kFlat N (skin/cell.h).
inline constexpr double kSmallestNormalSquared = 1e-20;

template <class Real>
using Vector3 = Eigen::Matrix<Real, 3, 1>;

template <class Real>
struct Trilinear {
  std::array<Real, 8> weight;             ///< N_k
  std::array<Vector3<Real>, 8> gradient;  ///< grad N_k, per edge length

  explicit Trilinear(const Vector3<Real>& xi) {
    for (unsigned k = 0; k < 8; ++k) {
      Vector3<Real> factor, slope;
      for (unsigned d = 0; d < 3; ++d) {
        const bool high = ((k >> d) & 1u) != 0;
        factor[d] = high ? xi[d] : 1 - xi[d];
        slope[d] = high ? Real(1) : Real(-1);
      }
      weight[k] = factor[0] * factor[1] * factor[2];
      gradient[k] = {slope[0] * factor[1] * factor[2], factor[0] * slope[1] * factor[2],
                     factor[0] * factor[1] * slope[2]};
    }
  }
};

template <class Real>
struct SurfacePoint {
  Vector3<Real> position, normal;
};

/// One vertex. @param corners  the cell's eight corners; @param rest_normal  unit length, kept where the cell
/// is flat.
template <class Real>
SurfacePoint<Real> evaluate_trilinear(const Vector3<Real>& xi, const Vector3<Real>& rest_normal,
                                      const std::array<Vector3<Real>, 8>& corners) {
  const Trilinear<Real> map(xi);
  SurfacePoint<Real> point{Vector3<Real>::Zero(), rest_normal};
  Vector3<Real> f1 = Vector3<Real>::Zero(), f2 = f1, f3 = f1;
  for (std::size_t k = 0; k < 8; ++k) {
    point.position += map.weight[k] * corners[k];
    f1 += map.gradient[k].x() * corners[k];
    f2 += map.gradient[k].y() * corners[k];
    f3 += map.gradient[k].z() * corners[k];
  }
  const Vector3<Real> n =
      rest_normal.x() * f2.cross(f3) + rest_normal.y() * f3.cross(f1) + rest_normal.z() * f1.cross(f2);
  const Real squared = n.squaredNorm();
  if (squared >= static_cast<Real>(kSmallestNormalSquared)) point.normal = n / std::sqrt(squared);
  return point;
}

}  // namespace softcell::ppu
