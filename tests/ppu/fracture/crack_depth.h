#pragma once
// How far the sides of a crack are in each other.

#include <algorithm>
#include <cstdint>

#include "ppu/fracture/cracks.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// For particles that a crack across x has made two of, how far the right one is left of the left one, in cells.
template <int kDimension>
float deepest_in_crack(const SoftBody<kDimension>& bar) {
  const Lattice<kDimension>& lattice = bar.model().lattice();
  float deepest = 0;
  for (const auto& face : bar.model().cracks().faces) {
    const auto &low = lattice.corners[face.low], &high = lattice.corners[face.high];
    for (std::uint32_t k = 0; face.axis == 0 && k < low.size(); k += 2)
      if (low[k + 1] != high[k])
        deepest = std::max(deepest, (bar.position(low[k + 1]) - bar.position(high[k])).x() / lattice.spacing);
  }
  return deepest;
}

}  // namespace softcell::ppu
