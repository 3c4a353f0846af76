#pragma once
// The rotations of a body's regions in main memory. A piece of a broken body begins with those of the whole.

#include <cstdint>
#include <span>
#include <vector>

#include "match_job.h"

namespace softcell::ppu {

struct RegionRotations {
  std::span<spu::MatchRotations> rotations;  ///< groups of four
  std::vector<std::uint32_t> place_of;       ///< of each particle: where the rotation of its region is
  std::uint32_t& cold;                       ///< not 0: the next step ignores the rotations

  /// Copies the rotations of a whole body to its piece. @param particle_of  of each particle: its number in the whole
  void take_from(const RegionRotations& whole, std::span<const std::uint32_t> particle_of);
};

}  // namespace softcell::ppu
