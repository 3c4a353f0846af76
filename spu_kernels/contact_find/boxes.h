#pragma once
// Boxes in the lanes of registers, and sets of lanes that comparisons of four boxes leave.

#include <spu_intrinsics.h>

#include "common/lane_mask.h"
#include "common/vector3.h"
#include "contacts/deformed_cell.h"
#include "contacts/quad_vector.h"

namespace softcell::spu {

/// A box in all lanes.
struct BoxInAllLanes {
  Vector3x4 low, high;
};

/// Words whose top bit is set where a box has no point in common with the four boxes.
inline vec_uint4 apart(const BoxInAllLanes& box, vec_float4 low_x, vec_float4 low_y, vec_float4 low_z,
                       vec_float4 high_x, vec_float4 high_y, vec_float4 high_z) {
  return spu_or(spu_or(spu_or(less(box.high.x, low_x), less(box.high.y, low_y)),
                       spu_or(less(box.high.z, low_z), less(high_x, box.low.x))),
                spu_or(less(high_y, box.low.y), less(high_z, box.low.z)));
}

/// A bit for each lane whose top bit is not set: 8 is lane 0.
inline uint32_t lanes_left(vec_uint4 words) {
  return spu_extract(spu_gather(spu_rlmask(words, -31)), 0) ^ 15u;
}

/// Removes the first lane of a set and returns it.
inline uint32_t take_lane(uint32_t& lanes) {
  const uint32_t lane = static_cast<uint32_t>(__builtin_clz(lanes)) - 28;
  lanes &= ~(8u >> lane);
  return lane;
}

/// The box that two boxes have in common.
inline BoxInAllLanes common(const BoxInAllLanes& a, const BoxInAllLanes& b) {
  return {{larger(a.low.x, b.low.x), larger(a.low.y, b.low.y), larger(a.low.z, b.low.z)},
          {smaller(a.high.x, b.high.x), smaller(a.high.y, b.high.y), smaller(a.high.z, b.high.z)}};
}

/// @param by  x y z: how far to each side
inline BoxInAllLanes widened(const BoxInAllLanes& box, vec_float4 by) {
  const Vector3x4 wide = in_all_lanes(by);
  return {difference(box.low, wide),
          {spu_add(box.high.x, wide.x), spu_add(box.high.y, wide.y), spu_add(box.high.z, wide.z)}};
}

}  // namespace softcell::spu
