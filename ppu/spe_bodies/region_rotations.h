#pragma once
// The rotations of a body's regions in main memory: what a piece of a body that breaks begins with.

#include <cstdint>
#include <span>
#include <vector>

#include "match_job.h"

namespace softcell::ppu {

struct RegionRotations {
  std::span<spu::MatchRotations> rotations;  ///< four of a group
  std::vector<std::uint32_t> place_of;       ///< of each particle: where the rotation of its region is
  std::uint32_t& cold;                       ///< not 0: the next step does not look at them

  /// @param particle_of  of each particle: which one of the whole it was
  void take_from(const RegionRotations& whole, std::span<const std::uint32_t> particle_of);
};

}  // namespace softcell::ppu
