#pragma once
// A body of a task in the local store: its cells, and the distances from its surface at rest.
//
// Functions that are used in several places are not inlined, because the checked image of the kernel has little room for its code.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "contact_find_job.h"
#include "contacts/quad_vector.h"
#include "contacts/sequential_impulses.h"

namespace softcell::spu {

/// A FindCell as registers.
struct CellAtRest {
  vec_ushort8 corner;
  vec_short8 place;  // FindCell::grid, first_group, group_count, inner_cell and inner_node
  vec_float4 least;
  float field[28];
};
static_assert(sizeof(CellAtRest) == sizeof(FindCell), "the same bytes");

/// One body of a task in the local store.
struct BodyInStore {
  const CellAtRest* cells;
  const vec_float4* groups;  // four quadwords each
  const vec_float4* boxes;   // six quadwords for four cells
  const vec_float4* ends;
  const vec_float4* begins;  // x y z, and the roots of inverse masses
  uint32_t cell_count, particle_count;
  float spacing;
};

/// The distance in cells and its derivatives by s, interpolated trilinearly between the nodes of an eighth of the cell.
/// @param s  -1/2..1/2; x y z
/// @return   d/ds1, d/ds2, d/ds3, and the distance
__attribute__((noinline)) inline vec_float4 field_at(const float* field, vec_float4 s) {
  const vec_float4 place = spu_madd(s, spu_splats(2.0f), spu_splats(1.0f));  // 0..2
  const vec_int4 upper = (vec_int4)spu_andc(spu_splats(1u), spu_rlmask((vec_uint4)s, -31));
  const int32_t x = spu_extract(upper, 0), y = spu_extract(upper, 1), z = spu_extract(upper, 2);
  const vec_float4 f = spu_sub(place, spu_convtf(upper, 0));
  const float* const node = field + (z * 3 + y) * 3 + x;
  const vec_float4 low = {node[0], node[3], node[9], node[12]};  // x = 0: y z 00 10 01 11
  const vec_float4 high = {node[1], node[4], node[10], node[13]};
  const vec_float4 by_x = spu_sub(high, low);
  const vec_float4 at_x = spu_madd(splat_lane<0>(f), by_x, low);
  // Interpolates over y, then z: the distances and their slopes along x.
  const vec_uchar16 y_low = {0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27};
  const vec_uchar16 y_high = {4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31};
  const vec_float4 low_y = spu_shuffle(at_x, by_x, y_low);  // d z0, d z1, dx z0, dx z1
  const vec_float4 by_y = spu_sub(spu_shuffle(at_x, by_x, y_high), low_y);
  const vec_float4 at_y = spu_madd(splat_lane<1>(f), by_y, low_y);
  const vec_uchar16 z_low = {8, 9, 10, 11, 16, 17, 18, 19, 0, 1, 2, 3, 0, 1, 2, 3};
  const vec_uchar16 z_high = {12, 13, 14, 15, 20, 21, 22, 23, 4, 5, 6, 7, 4, 5, 6, 7};
  const vec_float4 z0 = spu_shuffle(at_y, by_y, z_low), z1 = spu_shuffle(at_y, by_y, z_high);
  const vec_float4 by_z = spu_sub(z1, z0);                       // dxz, dyz, dz, dz
  const vec_float4 at_z = spu_madd(splat_lane<2>(f), by_z, z0);  // dx, dy, d, d
  const vec_uchar16 slope_z = {0, 1, 2, 3, 4, 5, 6, 7, 24, 25, 26, 27, 12, 13, 14, 15};
  const vec_float4 all = spu_shuffle(at_z, by_z, slope_z);  // dx dy dz d
  const vec_float4 scale = {2.0f, 2.0f, 2.0f, 1.0f};
  return spu_mul(all, scale);
}

/// Trilinear shares of a cell's corners.
struct Shares {
  vec_float4 low, high;  // z = 0 and z = 1
};

inline Shares shares_at(vec_float4 s) {
  const vec_float4 half = spu_splats(0.5f);
  const vec_float4 upper = spu_add(half, s), lower = spu_sub(half, s);
  const vec_uchar16 x = {16, 17, 18, 19, 0, 1, 2, 3, 16, 17, 18, 19, 0, 1, 2, 3};
  const vec_uchar16 y = {20, 21, 22, 23, 20, 21, 22, 23, 4, 5, 6, 7, 4, 5, 6, 7};
  const vec_float4 xy = spu_mul(spu_shuffle(upper, lower, x), spu_shuffle(upper, lower, y));
  return {spu_mul(xy, splat_lane<2>(lower)), spu_mul(xy, splat_lane<2>(upper))};
}

__attribute__((noinline)) inline vec_float4 value_of(vec_ushort8 corner, const Shares& shares,
                                                     const vec_float4* values) {
  return value_at(Anchor{corner, {shares.low, shares.high}}, values);
}

}  // namespace softcell::spu
