#pragma once
// Bounds of near cells: compares four cells with a ball, or one cell with four points.

#include <spu_intrinsics.h>

#include "contact_find/boxes.h"
#include "contact_find/local_store.h"
#include "contact_find/sides.h"

namespace softcell::spu {
namespace {  // a part of contact_find.cpp, which alone includes it

/// A box and a ball around the points of a cell, in all lanes.
struct Region {
  BoxInAllLanes box;
  Vector3x4 middle;
  vec_float4 radius;
};

/// Bounds of four near cells, or of one in all lanes.
struct Bounds4 {
  Vector3x4 middle, row1, row2, row3, reach, length, slope;
  vec_float4 limit, steep;
};

/// @param at  the name of a row of ls.bounds
template <typename At>
inline Bounds4 bounds_at(const At& at) {
  const auto three = [&](uint32_t first) __attribute__((always_inline)) {
    return Vector3x4{at(first), at(first + 1), at(first + 2)};
  };
  using B = NearBounds;
  return {three(B::kMiddle), three(B::kRow1),  three(B::kRow1 + 3), three(B::kRow1 + 6), three(B::kReach),
          three(B::kLength), three(B::kSlope), at(B::kLimit),       at(B::kSteep)};
}

/// Four points relative to a cell.
struct RoughPlaces {
  Vector3x4 s;       // where they would be in the cell if it were a parallelepiped
  vec_float4 above;  // the value of the lower plane's function
};

inline RoughPlaces rough_places(const Bounds4& cell, const Vector3x4& point) {
  const Vector3x4 d = difference(point, cell.middle);
  return {{dot(cell.row1, d), dot(cell.row2, d), dot(cell.row3, d)}, dot(cell.slope, d)};
}

/// Words whose top bit is set where points cannot be in a cell and near its surface.
/// @param distance  metres: the radius around the points within which everything counts as one of them
inline vec_uint4 surely_far(const Bounds4& cell, const RoughPlaces& places, vec_float4 distance) {
  const auto beyond = [&](vec_float4 s, vec_float4 reach, vec_float4 length) __attribute__((always_inline)) {
    return less(spu_madd(length, distance, reach), absolute(s));
  };
  return spu_or(spu_or(beyond(places.s.x, cell.reach.x, cell.length.x),
                       beyond(places.s.y, cell.reach.y, cell.length.y)),
                spu_or(beyond(places.s.z, cell.reach.z, cell.length.z),
                       less(spu_madd(cell.steep, distance, cell.limit), places.above)));
}

/// The boxes of blocks.
void bound_blocks(NearCells& near) {
  for (uint32_t first = 0; first < near.count; first += 16) {
    const uint32_t end = first + 16 < near.count ? first + 16 : near.count;
    for (uint32_t k = 0; k < 6; ++k) {
      vec_float4 around = *reinterpret_cast<const vec_float4*>(near.box[k] + first);
      for (uint32_t i = first + 4; i < end; i += 4) {
        const vec_float4 four = *reinterpret_cast<const vec_float4*>(near.box[k] + i);
        around = k < 3 ? smaller(around, four) : larger(around, four);
      }
      near.block[first / 16][k] = around;
    }
  }
}

/// Writes the near cells that may hold a point of a region to ls.meets, in ascending order.
/// @param margin  metres, in all lanes
uint32_t gather_meeting(const Region& region, vec_float4 margin, const NearCells& near) {
  const vec_float4 distance = spu_add(region.radius, margin);
  uint32_t count = 0;
  for (uint32_t first = 0; first < near.count; first += 16) {
    const vec_float4* const block = near.block[first / 16];
    if (lanes_left(apart(region.box, block[0], block[1], block[2], block[3], block[4], block[5])) == 0)
      continue;
    const uint32_t end = first + 16 < near.count ? first + 16 : near.count;
    for (uint32_t i = first; i < end; i += 4) {
      const auto at = [&](uint32_t k) __attribute__((always_inline)) {
        return *reinterpret_cast<const vec_float4*>(near.box[k] + i);
      };
      const vec_uint4 far = apart(region.box, at(0), at(1), at(2), at(3), at(4), at(5));
      if (lanes_left(far) == 0) continue;
      const Bounds4 cells = bounds_at([&](uint32_t k) __attribute__((always_inline)) {
        return *reinterpret_cast<const vec_float4*>(ls.bounds.row[k] + i);
      });
      uint32_t left =
          lanes_left(spu_or(far, surely_far(cells, rough_places(cells, region.middle), distance)));
      while (left != 0) ls.meets[count++] = static_cast<uint16_t>(i + take_lane(left));
    }
  }
  return count;
}

/// Writes the bounds of four near cells to ls.bounds.
// Not inlined, so that its arrays do not take stack while the points of a cell do.
__attribute__((noinline)) void bound_four(const Sides& sides, const NearCells& near, uint32_t first) {
  vec_float4 middle[4], row1[4], row2[4], row3[4], reach[4], lengths[4], slope[4];
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t k = first + i < near.count ? first + i : near.count - 1;
    const CellAtRest& at_rest = sides.other.cells[near.cell[k]];
    const RoughInverse inverse = rough_inverse(deformed_cell(at_rest.corner, sides.other.ends), at_rest.least,
                                               sides.least_volume, kNearInField);
    middle[i] = inverse.middle;
    row1[i] = only_xyz(inverse.row1);
    row2[i] = only_xyz(inverse.row2);
    row3[i] = only_xyz(inverse.row3);
    const vec_float4 uphill = spu_madd(
        splat_lane<0>(inverse.least), row1[i],
        spu_madd(splat_lane<1>(inverse.least), row2[i], spu_mul(splat_lane<2>(inverse.least), row3[i])));
    vec_float4 limit = spu_sub(inverse.limit, splat_lane<3>(inverse.least));
    reach[i] = inverse.reach;
    if (spu_extract(inverse.reach, 0) < 0.0f)  // nothing is in it now; when it is less flat, there may be
      reach[i] = limit = spu_splats(0x1.93e594p+99f);  // 1e30
    const vec_float4 length12 = interleave_low(length_in_all_lanes(row1[i]), length_in_all_lanes(row2[i]));
    const vec_uchar16 two_and_one = {0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23};
    lengths[i] = with_fourth(spu_shuffle(length12, length_in_all_lanes(row3[i]), two_and_one),
                             length_in_all_lanes(uphill));
    slope[i] = with_fourth(uphill, limit);
  }
  const auto store = [&](uint32_t row, const vec_float4* of_cells, uint32_t count)
      __attribute__((always_inline)) {
    const Rows4 rows = transpose(Rows4{of_cells[0], of_cells[1], of_cells[2], of_cells[3]});
    const vec_float4* const quads = &rows.a;
    for (uint32_t k = 0; k < count; ++k)
      *reinterpret_cast<vec_float4*>(ls.bounds.row[row + k] + first) = quads[k];
  };
  using B = NearBounds;
  store(B::kMiddle, middle, 3);
  store(B::kRow1, row1, 3);
  store(B::kRow1 + 3, row2, 3);
  store(B::kRow1 + 6, row3, 3);
  store(B::kReach, reach, 3);
  store(B::kSlope, slope, 4);  // and kLimit
  store(B::kLength, lengths, 3);
  const Rows4 rows = transpose(Rows4{lengths[0], lengths[1], lengths[2], lengths[3]});
  *reinterpret_cast<vec_float4*>(ls.bounds.row[B::kSteep] + first) = rows.d;
}

}  // namespace
}  // namespace softcell::spu
