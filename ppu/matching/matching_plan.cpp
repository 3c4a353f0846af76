#include "ppu/matching/matching_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "ppu/matching/one_plate.h"
#include "ppu/matching/regions.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::ppu {
namespace {

SumPlan sums_of(const Lattice<3>& lattice, int half_width) {
  return {lattice, find_regions(lattice, half_width)};
}

SumPlan sums_of(const Lattice<2>& lattice, int half_width) {
  return {as_one_plate(lattice.particles), find_regions(lattice.neighbours, half_width)};
}

/// @throws std::invalid_argument  not one positive, finite mass per particle.
void check_masses(std::span<const float> masses, std::size_t particles) {
  if (masses.size() != particles)
    throw std::invalid_argument("MatchingPlan: " + std::to_string(masses.size()) + " masses for " +
                                std::to_string(particles) + " particles");
  for (std::size_t i = 0; i < masses.size(); ++i)
    if (!(masses[i] > 0) || !std::isfinite(masses[i]))
      throw std::invalid_argument("MatchingPlan: the mass of particle " + std::to_string(i) + " is " +
                                  base::shortest(masses[i]) + " kg; expected a positive number");
}

}  // namespace

template <typename Real, int kDimension>
MatchingPlan<Real, kDimension>::MatchingPlan(const Lattice<kDimension>& lattice, int half_width,
                                             std::span<const float> masses)
    : sums_(std::make_shared<const SumPlan>(sums_of(lattice, half_width))),
      half_width_(half_width),
      spacing_(static_cast<Real>(lattice.spacing)) {
  using Exact = Eigen::Matrix<double, kDimension, 1>;
  check_masses(masses, lattice.particles.size());

  const auto rest = [&](std::size_t i) -> Exact {
    return lattice.origin.template cast<double>() +
           static_cast<double>(lattice.spacing) * lattice.particles[i].template cast<double>();
  };
  SC_ASSERT(lattice.spacing > 0, "cells of {} m", lattice.spacing);
  SC_ASSERT(sums_->particles() == masses.size() && sums_->region_of().size() == masses.size(),
            "sums of {} particles, and {} masses", sums_->particles(), masses.size());
  double body_mass = 0;
  Exact weighted = Exact::Zero();
  for (std::size_t i = 0; i < masses.size(); ++i) {
    body_mass += static_cast<double>(masses[i]);
    weighted += static_cast<double>(masses[i]) * rest(i);
  }
  const Exact centre = weighted / body_mass;
  rest_centre_ = centre.template cast<Real>();

  std::vector<double> sizes;  // of each region
  for (std::size_t r = 0; r < sums_->regions(); ++r)
    sizes.push_back(static_cast<double>(sums_->members(r).size()));

  Real farthest = 0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double mass = static_cast<double>(masses[i]);
    // Membership is symmetric: |R_i| = |r| of r = i.
    const double region_count = sizes[sums_->region_of()[i]];
    const Vector x0 = (rest(i) - centre).template cast<Real>();
    particles_.push_back({x0, static_cast<Real>(mass / region_count), static_cast<Real>(1 / region_count),
                          static_cast<Real>(mass)});
    for (int d = 0; d < kDimension; ++d) farthest = std::max(farthest, std::abs(x0[d]));
  }
  noise_floor_ = 4 * std::numeric_limits<Real>::epsilon() * farthest * farthest;

  // Sums up the rounded constants, so that a body at rest has its centres exactly where they belong.
  for (std::size_t r = 0; r < sums_->regions(); ++r) {
    double mass = 0;
    Exact moment = Exact::Zero();
    for (const std::uint32_t i : sums_->members(r)) {
      const double modified = static_cast<double>(particles_[i].modified_mass);
      mass += modified;
      moment += modified * particles_[i].x0.template cast<double>();
    }
    SC_ASSERT(mass > 0, "region {} has a mass of {} kg", r, mass);
    regions_.push_back(
        {(moment / mass).template cast<Real>(), static_cast<Real>(mass), static_cast<Real>(1 / mass)});
  }
}

template <typename Real, int kDimension>
void MatchingPlan<Real, kDimension>::set_rest(std::span<const Eigen::Matrix<double, kDimension, 1>> rest) {
  using Exact = Eigen::Matrix<double, kDimension, 1>;
  SC_ASSERT(rest.size() == particles_.size(), "{} positions of {} particles", rest.size(), particles_.size());
  double mass = 0;
  Exact centre = Exact::Zero();
  for (std::size_t i = 0; i < rest.size(); ++i) {
    mass += static_cast<double>(particles_[i].mass);
    centre += static_cast<double>(particles_[i].mass) * rest[i];
  }
  centre /= mass;
  for (std::size_t i = 0; i < rest.size(); ++i) particles_[i].x0 = (rest[i] - centre).template cast<Real>();

  // Sums up the rounded constants, as above, but with sums that regions share.
  std::vector<Exact> moments(rest.size()), of_regions(regions_.size());
  for (std::size_t i = 0; i < rest.size(); ++i)
    moments[i] = static_cast<double>(particles_[i].modified_mass) * particles_[i].x0.template cast<double>();
  SumScratch<Exact> scratch(*sums_);
  sum_up<Exact>(*sums_, moments, scratch, of_regions);
  for (std::size_t r = 0; r < regions_.size(); ++r)
    regions_[r].c0 = (of_regions[r] / static_cast<double>(regions_[r].mass)).template cast<Real>();
}

template class MatchingPlan<float, 2>;
template class MatchingPlan<double, 2>;
template class MatchingPlan<float, 3>;
template class MatchingPlan<double, 3>;

}  // namespace softcell::ppu
