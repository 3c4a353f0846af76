#pragma once
// The order in which vertices are evaluated one after the other: the slots of a part, group by group. A group
// that continues the one before it lies in the same cell, whose corners are looked up once.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "ppu/lattice/embedding.h"
#include "ppu/reference/trilinear.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

/// Evaluates each slot of a part in float; trilinear.h has the equations.
/// @param position_of  (particle) -> Eigen::Vector3f, metres
/// @param write        (slot, const SurfacePoint<float>&); slot 4 * part.first_group first, ascending
template <class PositionOf, class Write>
void for_each_slot(const Embedding& embedding, const SkinPart& part, const PositionOf& position_of,
                   const Write& write) {
  SC_ASSERT(part.first_group + part.group_count <= embedding.groups.size(), "groups {} to {} of {}",
            part.first_group, part.first_group + part.group_count, embedding.groups.size());
  std::array<Eigen::Vector3f, 8> corners;
  for (std::uint32_t g = part.first_group; g < part.first_group + part.group_count; ++g) {
    const spu::SkinGroup& group = embedding.groups[g];
    SC_ASSERT(g != part.first_group || group.continues[0] == 0,
              "the first group, {}, of a part continues one", g);
    if (group.continues[0] == 0) {
      for (std::size_t k = 0; k < 8; ++k) corners[k] = position_of(part.particle(group.corner[k]));
    }
    for (std::uint32_t lane = 0; lane < 4; ++lane) {
      write(4 * g + lane, evaluate_trilinear<float>(
                              {group.xi[lane], group.eta[lane], group.zeta[lane]},
                              {group.normal_x[lane], group.normal_y[lane], group.normal_z[lane]}, corners));
    }
  }
}

}  // namespace softcell::ppu
