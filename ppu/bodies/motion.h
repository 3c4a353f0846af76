#pragma once
// How a soft body moves as a whole: its centre, its velocity, its spin, and which way it is turned.

#include <Eigen/Core>
#include <utility>

#include "ppu/numbers/turning.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// Sums over the body in double precision, so that positions far from the origin lose no accuracy.
template <int kDimension>
struct Motion {
  using Vector = Eigen::Vector<double, kDimension>;
  using Matrix = Eigen::Matrix<double, kDimension, kDimension>;

  Vector centre = Vector::Zero();    ///< metres
  Vector velocity = Vector::Zero();  ///< m/s, of the centre
  turning::Axial<kDimension> spin;   ///< kg m^2/s, angular momentum about the centre
  decltype(turning::inertia_of(std::declval<Matrix>())) inertia;  ///< kg m^2, about the centre
};

template <int kDimension>
Motion<kDimension> motion_of(const SoftBody<kDimension>& body);

/// The rotation about `centre` (metres) by which the rest shape fits the present one best.
template <int kDimension>
typename Motion<kDimension>::Matrix orientation_of(const SoftBody<kDimension>& body,
                                                   const typename Motion<kDimension>::Vector& centre);

}  // namespace softcell::ppu
