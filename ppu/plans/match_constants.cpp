#include "ppu/plans/match_constants.h"

#include <algorithm>
#include <cmath>

#include "softcell/base/assert.h"

namespace softcell::ppu {

spu::MatchHold hold_of(const Lattice<3>& lattice, const MatchingPlan<float, 3>& matching) {
  SC_ASSERT(lattice.particles.size() == matching.particles() && matching.particles() > 0,
            "a lattice of {} particles, matching of {}", lattice.particles.size(), matching.particles());
  double mass = 0, largest = 0;
  for (const auto& particle : matching.particle_constants()) {
    mass += static_cast<double>(particle.mass);
    largest = std::max(largest, static_cast<double>(particle.mass));
  }
  SC_ASSERT(largest > 0 && lattice.spacing > 0, "the heaviest particle has {} kg, in cells of {} m", largest,
            lattice.spacing);
  Eigen::Array3i low = lattice.particles[0], high = low;
  for (const Eigen::Vector3i& p : lattice.particles) {
    low = low.min(p.array());
    high = high.max(p.array());
  }
  const double size = static_cast<double>(lattice.spacing) * std::max(1, (high - low).maxCoeff());
  const double most = static_cast<double>(spu::kMatchPullLimit) / (largest * size / 16);
  const double scale = std::exp2(std::floor(std::log2(most)));
  return {static_cast<float>(scale), static_cast<float>(1 / (scale * mass))};
}

std::array<std::uint32_t, spu::kMatchSamples> samples_of(const MatchingPlan<float, 3>& matching) {
  SC_ASSERT(matching.particles() > 0, "{} samples of no particles", spu::kMatchSamples);
  std::array<std::uint32_t, spu::kMatchSamples> samples{};
  for (std::size_t k = 0; k < samples.size(); ++k)
    samples[k] = static_cast<std::uint32_t>((2 * k + 1) * matching.particles() / (2 * samples.size()));
  return samples;
}

void set_centre(spu::MatchRegions& group, std::uint32_t lane, const MatchingPlan<float, 3>::Region& region) {
  SC_ASSERT(lane < 4, "lane {} of four", lane);
  group.centre_x[lane] = region.c0.x();
  group.centre_y[lane] = region.c0.y();
  group.centre_z[lane] = region.c0.z();
}

std::array<float, 4> rest_moment(const MatchingPlan<float, 3>::Particle& particle) {
  const float m = particle.modified_mass;
  return {m * particle.x0.x(), m * particle.x0.y(), m * particle.x0.z(), m};
}

}  // namespace softcell::ppu
