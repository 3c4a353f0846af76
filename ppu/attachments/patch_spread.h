#pragma once
// How the mass of a patch is spread: it decides where places in common are held, and how far from its middle a patch can hold one.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "ppu/attachments/attached_body.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

/// Mass, middle and spread of a patch, or of two together: S in attachment_rows.h.
template <int kDimension>
struct Spread {
  using Vector = Eigen::Vector<float, kDimension>;
  using Matrix = Eigen::Matrix<float, kDimension, kDimension>;
  float mass = 0;
  Vector middle = Vector::Zero();
  Matrix root = Matrix::Zero();  // L, lower triangular; L L' = S
  Matrix inverse_of_root;

  void add_masses(const PatchParticles<kDimension>& patch) {
    for (std::size_t i = 0; i < patch.particles.size(); ++i) {
      mass += patch.masses[i];
      middle += patch.masses[i] * patch.positions[i];
    }
  }
  void add_squares(const PatchParticles<kDimension>& patch) {
    for (std::size_t i = 0; i < patch.particles.size(); ++i) {
      const Vector r = patch.positions[i] - middle;
      root += patch.masses[i] / mass * (r * r.transpose());
    }
  }
  /// @throws std::invalid_argument  the particles lie in a plane (in two dimensions on a line), or nearly so.
  void take_root() {
    constexpr float kFlat = 1e-3f;
    const Eigen::LLT<Matrix> cholesky(root);
    root = cholesky.matrixL();
    const float thinnest = root.diagonal().minCoeff(), thickest = root.diagonal().maxCoeff();
    if (cholesky.info() != Eigen::Success || !(thinnest * thinnest > kFlat * thickest * thickest))
      throw std::invalid_argument(kDimension == 3 ? "a hinge, or a weld of two soft bodies, needs patches of "
                                                    "at least four particles that do not lie in a plane"
                                                  : "a hinge, or a weld of two soft bodies, needs patches of "
                                                    "at least three particles that do not lie on a line");
    inverse_of_root = root.inverse();
  }
};

/// @throws std::invalid_argument  as Spread::take_root()
template <int kDimension>
Spread<kDimension> spread_of(const PatchParticles<kDimension>& a,
                             const PatchParticles<kDimension>* b = nullptr) {
  Spread<kDimension> spread;
  spread.add_masses(a);
  if (b != nullptr) spread.add_masses(*b);
  SC_ASSERT(spread.mass > 0, "a patch of {} particles has a mass of {} kg", a.particles.size(), spread.mass);
  spread.middle /= spread.mass;
  spread.add_squares(a);
  if (b != nullptr) spread.add_squares(*b);
  spread.take_root();
  return spread;
}

/// The corners of a regular simplex of dimension + 1 corners, of which any two have the product -1.
template <int kDimension>
std::vector<Eigen::Vector<float, kDimension>> simplex() {
  if constexpr (kDimension == 3) {
    return {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  } else {
    const float height = std::sqrt(1.5f), half = std::sqrt(0.5f);
    return {{0, 2 * half}, {height, -half}, {-height, -half}};
  }
}

}  // namespace softcell::ppu
