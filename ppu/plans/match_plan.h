#pragma once
// The plan of the kernel `match`: a model's constants and sum lists as the SPE reads them.

#include "match_job.h"
#include "ppu/matching/matching_plan.h"
#include "ppu/plans/kernel_plan.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// Bars, plates and regions are those of SumPlan; equal ones exist once. The plan adds an order: along a row of the lattice each bar
/// follows the one that differs from it by one particle at either end, so that a sum is made from its predecessor by one addition and one
/// subtraction, whatever the half-width; plates and regions likewise.
class MatchPlan : public KernelPlan<spu::MatchPlanHeader> {
 public:
  /// @param arena_bytes  local store for plan and state: kMatchArenaBytes, or for the checked kernel kMatchCheckedArenaBytes.
  /// @throws BodyTooLarge
  MatchPlan(const Lattice<3>& lattice, const MatchingPlan<float, 3>& matching,
            std::uint32_t arena_bytes = spu::kMatchArenaBytes);
};

}  // namespace softcell::ppu
