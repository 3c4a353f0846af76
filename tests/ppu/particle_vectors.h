#pragma once
// A vector for each particle of a body, in two or three dimensions: how far apart two such are, and what they
// add up to.

#include <Eigen/Core>
#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "gtest/gtest.h"

namespace softcell::ppu::test {

template <class Vector>
double largest_difference(const std::vector<Vector>& a, const std::vector<Vector>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = std::max(largest, static_cast<double>((a[i] - b[i]).cwiseAbs().maxCoeff()));
  return largest;
}

inline double total_mass(const std::vector<float>& masses) {
  return std::accumulate(masses.begin(), masses.end(), 0.0);
}

/// @param v  velocities; or pulls, of which the sum is to be nothing
template <class Vector>
Vector momentum(const std::vector<float>& masses, const std::vector<Vector>& v) {
  Vector sum = Vector::Zero();
  for (std::size_t i = 0; i < v.size(); ++i) sum += double{masses[i]} * v[i];
  return sum;
}

/// Kinetic.
template <class Vector>
double energy(const std::vector<float>& masses, const std::vector<Vector>& v) {
  double sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i) sum += double{masses[i]} * v[i].squaredNorm() / 2;
  return sum;
}

/// Runs a check on every lattice with every half-width from `first` to 4.
/// @param lattices  pairs of a name and a lattice
template <class Lattices, class Check>
void for_every_half_width(const Lattices& lattices, int first, const Check& check) {
  for (const auto& [name, lattice] : lattices) {
    for (int w = first; w <= 4; ++w) {
      SCOPED_TRACE(name + ", w = " + std::to_string(w));
      check(lattice, w);
    }
  }
}

}  // namespace softcell::ppu::test
