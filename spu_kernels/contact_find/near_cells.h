#pragma once
// Finds the cells of one body that are near another one: in a box, and between two planes.

#include <spu_intrinsics.h>

#include "contact_find/boxes.h"
#include "contact_find/local_store.h"

namespace softcell::spu {
namespace {  // a part of contact_find.cpp, which alone includes it

/// How far a body reaches along a direction, and each of its particles.
struct Reach {
  float least, most;
};

Reach reach_along(const BodyInStore& body, vec_float4 direction, float* along) {
  const Vector3x4 d = in_all_lanes(direction);
  vec_float4 least = spu_splats(1e38f), most = spu_splats(-1e38f);
  for (uint32_t p = 0; p < body.particle_count; p += 4) {
    const auto at = [&](uint32_t i) __attribute__((always_inline)) {
      return body.ends[p + i < body.particle_count ? p + i : body.particle_count - 1];
    };
    const Rows4 rows = transpose(Rows4{at(0), at(1), at(2), at(3)});
    const vec_float4 place = dot(d, Vector3x4{rows.a, rows.b, rows.c});
    *reinterpret_cast<vec_float4*>(along + p) = place;
    least = smaller(least, place);
    most = larger(most, place);
  }
  return {-largest_lane(negative(least)), largest_lane(most)};
}

inline Reach widened(const Reach& reach, vec_float4 direction, float margin) {
  const vec_float4 wide = spu_mul(length_in_all_lanes(direction), spu_splats(margin));
  return {reach.least - spu_extract(wide, 0), reach.most + spu_extract(wide, 0)};
}

/// The conditions for a cell to be near: it meets a box, and reaches between two planes.
struct Nearness {
  BoxInAllLanes box;
  const float* along;  // of the body's particles; null: no plane
  float least, most;   // the planes: at least one corner of the cell is between them
};

/// Finds the cells of a body that are near the other, and the box around them.
/// @return  false: there are too many
bool gather_near(const BodyInStore& body, const Nearness& nearness, NearCells& near, BoxInAllLanes& around) {
  near.count = 0;
  vec_float4 around_low = spu_splats(0x1.93e594p+99f), around_high = spu_splats(-0x1.93e594p+99f);  // 1e30
  const uint32_t groups = (body.cell_count + 3) / 4;
  for (uint32_t g = 0; g < groups; ++g) {
    const vec_float4* const b = body.boxes + g * 6;
    uint32_t left = lanes_left(apart(nearness.box, b[0], b[1], b[2], b[3], b[4], b[5]));
    while (left != 0) {
      const uint32_t lane = take_lane(left), cell = 4 * g + lane;
      if (cell >= body.cell_count) break;
      if (nearness.along != nullptr) {
        const vec_ushort8 corner = body.cells[cell].corner;
        const auto along = [&](int k) __attribute__((always_inline)) {
          return nearness.along[spu_extract(corner, k)];
        };
        const vec_float4 low = {along(0), along(1), along(2), along(3)};
        const vec_float4 high = {along(4), along(5), along(6), along(7)};
        // Whether all corners are below, or all above.
        const vec_float4 least = spu_splats(nearness.least), most = spu_splats(nearness.most);
        const vec_uint4 below = spu_and(less(low, least), less(high, least));
        const vec_uint4 above = spu_and(less(most, low), less(most, high));
        if (lanes_left(below) == 0 || lanes_left(above) == 0) continue;
      }
      if (near.count == kFindMaxNear) return false;
      const float* const of_lane = reinterpret_cast<const float*>(b) + lane;
      for (uint32_t i = 0; i < 6; ++i) near.box[i][near.count] = of_lane[4 * i];
      const vec_float4 low = {of_lane[0], of_lane[4], of_lane[8], 0.0f};
      const vec_float4 high = {of_lane[12], of_lane[16], of_lane[20], 0.0f};
      around_low = smaller(around_low, low);
      around_high = larger(around_high, high);
      near.cell[near.count] = static_cast<uint16_t>(cell);
      ++near.count;
    }
  }
  for (uint32_t i = near.count; i < near.count + 4; ++i) {  // boxes that meet nothing fill up the last four
    for (uint32_t k = 0; k < 3; ++k) near.box[k][i] = 0x1.93e594p+99f;   // 1e30
    for (uint32_t k = 3; k < 6; ++k) near.box[k][i] = -0x1.93e594p+99f;  // 1e30
  }
  around = {in_all_lanes(around_low), in_all_lanes(around_high)};
  return true;
}

}  // namespace
}  // namespace softcell::spu
