#pragma once
// What both shape matchers, of two and three dimensions, ask of their arguments.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

namespace softcell::ppu {

/// @throws std::invalid_argument  not one positive, finite mass per particle.
inline void check_masses(std::span<const float> masses, std::size_t particles) {
  if (masses.size() != particles)
    throw std::invalid_argument("MatchingPlan: " + std::to_string(masses.size()) + " masses for " +
                                std::to_string(particles) + " particles");
  for (std::size_t i = 0; i < masses.size(); ++i)
    if (!(masses[i] > 0) || !std::isfinite(masses[i]))
      throw std::invalid_argument("MatchingPlan: the mass of particle " + std::to_string(i) + " is " +
                                  std::to_string(masses[i]) + " kg; expected a positive number");
}

/// @throws std::invalid_argument  a number outside its range.
inline void check_step(double alpha, double damping, double h) {
  const auto check_range = [](const char* name, double value) {
    if (!(value >= 0 && value <= 1))
      throw std::invalid_argument(std::string("ShapeMatcher: ") + name + " " + std::to_string(value) +
                                  ": expected 0 to 1");
  };
  check_range("alpha", alpha);
  check_range("damping", damping);
  if (!(h > 0) || !std::isfinite(h))
    throw std::invalid_argument("ShapeMatcher: time step " + std::to_string(h) +
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

}  // namespace softcell::ppu
