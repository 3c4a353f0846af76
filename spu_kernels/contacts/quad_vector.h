#pragma once
// One 3-vector in a register: x y z, and a fourth lane that is 0 or has another meaning.

#include <spu_intrinsics.h>

#include "common/reciprocal.h"
#include "common/transpose.h"

namespace softcell::spu {

template <int kLane>
inline vec_float4 splat_lane(vec_float4 v) {
  constexpr unsigned char b = 4 * kLane;
  const vec_uchar16 pattern = {b, b + 1, b + 2, b + 3, b, b + 1, b + 2, b + 3,
                               b, b + 1, b + 2, b + 3, b, b + 1, b + 2, b + 3};
  return spu_shuffle(v, v, pattern);
}

/// All ones in lanes whose number is below zero.
inline vec_uint4 below_zero(vec_float4 v) { return (vec_uint4)spu_rlmaska((vec_int4)v, -31); }

/// The larger number of each lane.
inline vec_float4 larger(vec_float4 a, vec_float4 b) { return spu_sel(a, b, below_zero(spu_sub(a, b))); }
inline vec_float4 smaller(vec_float4 a, vec_float4 b) { return spu_sel(b, a, below_zero(spu_sub(a, b))); }

/// The numbers, but 0 in lanes whose number is below zero.
inline vec_float4 not_below_zero(vec_float4 v) { return (vec_float4)spu_andc((vec_uint4)v, below_zero(v)); }

inline vec_float4 negative(vec_float4 v) {
  return (vec_float4)spu_xor((vec_uint4)v, spu_splats(0x80000000u));
}

/// x y z of a vector, and 0.
inline vec_float4 only_xyz(vec_float4 v) {
  const vec_uint4 xyz = {0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 0};
  return (vec_float4)spu_and((vec_uint4)v, xyz);
}

/// x y z of one vector, the fourth lane of another.
inline vec_float4 with_fourth(vec_float4 xyz, vec_float4 fourth) {
  const vec_uint4 last = {0, 0, 0, 0xFFFFFFFFu};
  return spu_sel(xyz, fourth, last);
}

/// a . b in all lanes. @pre the product of the fourth lanes is 0
inline vec_float4 dot_in_all_lanes(vec_float4 a, vec_float4 b) { return sum_of_lanes(spu_mul(a, b)); }

/// |v|, of a vector whose fourth lane is 0.
inline vec_float4 length_in_all_lanes(vec_float4 v) {
  const vec_float4 square = dot_in_all_lanes(v, v);
  return spu_mul(square, reciprocal_sqrt(square));
}

/// y z x, and the fourth lane.
inline vec_float4 turned_left(vec_float4 v) {
  const vec_uchar16 yzx = {4, 5, 6, 7, 8, 9, 10, 11, 0, 1, 2, 3, 12, 13, 14, 15};
  return spu_shuffle(v, v, yzx);
}

/// a x b; the fourth lane is 0 except for rounding.
inline vec_float4 cross_of(vec_float4 a, vec_float4 b) {
  return turned_left(spu_msub(a, turned_left(b), spu_mul(turned_left(a), b)));
}

}  // namespace softcell::spu
