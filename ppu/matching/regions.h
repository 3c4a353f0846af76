#pragma once
// Regions: the overlapping sets of particles that move as rigidly as they can.

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

inline constexpr int kMaxHalfWidth = 16;                       ///< links; useful values are 1 to 4
inline constexpr std::uint32_t kMaxRegionMembers = 64u << 20;  ///< of all regions of a lattice together

/// List r holds the particles within `half_width` links of particle r, itself included, in ascending order.
/// Links, not distances: the two tips of a horseshoe share no region unless they are that near along the
/// material. Membership is symmetric: i is in list r exactly when r is in list i.
/// @param neighbours  of each particle, as Lattice has them.
/// @param half_width  0..kMaxHalfWidth; 0 makes every particle a region of its own.
/// @throws std::runtime_error  half width out of range, or more than kMaxRegionMembers entries; far more are refused before memory is
///         allocated for them.
/// @source  [LSM07]
Csr find_regions(const Csr& neighbours, int half_width);
inline Csr find_regions(const Lattice<3>& lattice, int half_width) {
  return find_regions(lattice.neighbours, half_width);
}

}  // namespace softcell::ppu
