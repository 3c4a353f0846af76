#pragma once
// The order in which the kernels make the sums of a lattice. It is the same whether a body is stepped as a whole or in tiles: the same
// chains, hence the same bits.

#include <cstdint>
#include <vector>

#include "match_job.h"
#include "ppu/matching/summation.h"
#include "ppu/plans/kernel_plan.h"
#include "ppu/plans/sum_list.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// SumPlan's bars, plates and regions, each in order and numbered by slot: 1, 2, 3, ... Particle i is slot
/// i + 1. Bars follow one another along z, plates along y, regions along x.
struct LatticeSums {
  /// @param plate_restart  along y sums start anew at multiples of it: sum_restart_of_rows() of the lattice.
  LatticeSums(const Lattice<3>& lattice, const SumPlan& sums, int plate_restart);

  SumLevel bars_of_particles, bars_of_regions, plates, regions;
  std::vector<std::uint32_t> region_slot;     ///< of SumPlan's regions
  std::vector<std::uint32_t> region_at_slot;  ///< the inverse; [0] is unused
  std::vector<std::uint32_t> home;            ///< of SumPlan's regions: the lowest particle that has it
};

/// Sums start anew at multiples of this along x and z; along y at multiples of sum_restart_of_rows().
inline constexpr int kSumRestart = KernelPlan<spu::MatchPlanHeader>::kRestart;

/// Rows (y) of a lattice that a tile may have, estimated from the lattice's height (z): as many as fit the local store of the kernel
/// match_tiles, at least one.
/// @param arena_bytes  as for TilePlan
int rows_that_fit(const Lattice<3>& lattice, int half_width, std::uint32_t arena_bytes);

/// The same for the unchecked kernel, at most kSumRestart, so that sums do not depend on whether a kernel is checked.
int sum_restart_of_rows(const Lattice<3>& lattice, int half_width);

}  // namespace softcell::ppu
