#pragma once

#include <cstdint>
#include <vector>

#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// The particles of a body whose rest position passes a test, ascending.
template <int kDimension, typename Is>
std::vector<std::uint32_t> particles_where(const SoftBody<kDimension>& body, const Is& is) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < body.model().particles(); ++i)
    if (is(body.model().lattice().rest_position(i))) numbers.push_back(i);
  return numbers;
}

}  // namespace softcell::ppu
