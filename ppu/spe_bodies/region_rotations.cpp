#include "ppu/spe_bodies/region_rotations.h"

#include "softcell/base/assert.h"

namespace softcell::ppu {

void RegionRotations::take_from(const RegionRotations& whole, std::span<const std::uint32_t> particle_of) {
  SC_ASSERT(particle_of.size() == place_of.size(), "{} particles of {}", particle_of.size(), place_of.size());
  for (std::size_t i = 0; i < particle_of.size(); ++i) {
    const std::uint32_t from = whole.place_of[particle_of[i]], to = place_of[i];
    const spu::MatchRotations& old = whole.rotations[from / 4];
    spu::MatchRotations& own = rotations[to / 4];
    own.x[to % 4] = old.x[from % 4];
    own.y[to % 4] = old.y[from % 4];
    own.z[to % 4] = old.z[from % 4];
    own.w[to % 4] = old.w[from % 4];
  }
  cold = whole.cold;
}

}  // namespace softcell::ppu
