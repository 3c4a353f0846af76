#pragma once
// Checks of a shape matcher's arguments, and positions relative to a point in the body.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::ppu {

/// @throws std::invalid_argument  not one vector per particle in both.
inline void check_sizes(std::size_t particles, std::size_t positions, std::size_t others) {
  if (positions != particles || others != particles)
    throw std::invalid_argument("ShapeMatcher: expected one vector per particle, " +
                                std::to_string(particles) + "; got " + std::to_string(positions) + " and " +
                                std::to_string(others));
}

/// @throws std::invalid_argument  a number outside its range.
inline void check_step(double alpha, double damping, double h) {
  const auto check_range = [](const char* name, double value) {
    if (!(value >= 0 && value <= 1))
      throw std::invalid_argument(std::string("ShapeMatcher: ") + name + " " + base::shortest(value) +
                                  ": expected 0 to 1");
  };
  check_range("alpha", alpha);
  check_range("damping", damping);
  if (!(h > 0) || !std::isfinite(h))
    throw std::invalid_argument("ShapeMatcher: time step " + base::shortest(h) +
                                " s: expected a positive number");
}

/// The mean of the vectors, in double precision.
/// @throws std::runtime_error  one of them is NaN or infinite; the sentence names the particle.
template <typename Vector>
Eigen::Matrix<double, Vector::RowsAtCompileTime, 1> finite_mean(std::span<const Vector> vectors,
                                                                const char* what) {
  Eigen::Matrix<double, Vector::RowsAtCompileTime, 1> sum;
  sum.setZero();
  for (const Vector& vector : vectors) sum += vector.template cast<double>();
  if (!sum.allFinite()) {
    const auto bad =
        std::find_if(vectors.begin(), vectors.end(), [](const Vector& v) { return !v.allFinite(); });
    const std::string who =
        bad == vectors.end() ? "of the body" : "of particle " + std::to_string(bad - vectors.begin());
    throw std::runtime_error(std::string("soft body: the ") + what + " " + who + " is not a finite number");
  }
  return sum / static_cast<double>(vectors.size());
}

/// Positions relative to a point in the body. A grid point, so that it does not move with every step; far
/// from the world's origin the sums would otherwise cancel to nothing.
/// @throws  as finite_mean()
template <typename Vector>
void localise(std::span<const Vector> positions, typename Vector::Scalar spacing,
              std::vector<Vector>& local) {
  SC_ASSERT(local.size() == positions.size() && spacing > 0, "room for {} of {} positions, cells of {} m",
            local.size(), positions.size(), spacing);
  using Real = typename Vector::Scalar;
  const auto mean = finite_mean<Vector>(positions, "position");
  const double s = static_cast<double>(spacing);
  Vector origin;
  for (int d = 0; d < Vector::RowsAtCompileTime; ++d)
    origin[d] = static_cast<Real>(std::floor(mean[d] / s + 0.5) * s);
  for (std::size_t i = 0; i < positions.size(); ++i) local[i] = positions[i] - origin;
}

}  // namespace softcell::ppu
