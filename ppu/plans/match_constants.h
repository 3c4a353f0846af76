#pragma once
// Constants of a whole body in the plans of the kernels match and match_tiles.

#include <array>
#include <cstdint>

#include "match_job.h"
#include "ppu/matching/matching_plan.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

spu::MatchHold hold_of(const Lattice<3>& lattice, const MatchingPlan<float, 3>& matching);

/// Chooses particles spread over the whole body.
std::array<std::uint32_t, spu::kMatchSamples> samples_of(const MatchingPlan<float, 3>& matching);

/// Sets the rest centre of one of four regions.
void set_centre(spu::MatchRegions& group, std::uint32_t lane, const MatchingPlan<float, 3>::Region& region);

/// m~ (x0 y0 z0 1) of a particle.
std::array<float, 4> rest_moment(const MatchingPlan<float, 3>::Particle& particle);

}  // namespace softcell::ppu
