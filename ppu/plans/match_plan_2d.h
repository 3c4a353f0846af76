#pragma once
// The plan of the kernel `match_2d`: a model's constants and sum lists as the SPE reads them.

#include "match_2d_job.h"
#include "ppu/matching/matching_plan.h"
#include "ppu/plans/kernel_plan.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// A square body of this many particles (36 x 36) fits the kernel's local store with regions of any width; with narrow ones, and in other
/// shapes, somewhat larger bodies fit.
inline constexpr std::size_t kParticlesThatFit2d = 36 * 36;

/// The plan of a body in two dimensions, which has two levels of sums: from particles to bars along y, from bars to regions along x.
class MatchPlan2d : public KernelPlan<spu::MatchPlanHeader2d> {
 public:
  /// @throws BodyTooLarge  plan and state of the bodies under way need more local store than the kernel has; the message states both sizes.
  MatchPlan2d(const Lattice<2>& lattice, const MatchingPlan<float, 2>& matching);
};

}  // namespace softcell::ppu
