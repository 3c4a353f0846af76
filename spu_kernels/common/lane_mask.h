#pragma once
// Comparisons of four lanes whose results are sign bits. They are cheap on the SPU and on the host; comparisons that make masks are not.

#include <spu_intrinsics.h>
#include <stdint.h>

namespace softcell::spu {

/// True when the top bit of any word is set.
inline bool any_negative(vec_uint4 words) { return spu_extract(spu_gather(spu_rlmask(words, -31)), 0) != 0; }

/// All ones in the lanes whose top bit is set.
inline vec_uint4 negative_lanes(vec_uint4 words) { return spu_sub(spu_splats(0u), spu_rlmask(words, -31)); }

/// Words whose top bit is set where a < b; the other bits mean nothing.
inline vec_uint4 less(vec_float4 a, vec_float4 b) { return (vec_uint4)spu_sub(a, b); }

/// Words whose top bit is set where a >= b.
inline vec_uint4 not_less(vec_float4 a, vec_float4 b) { return spu_xor(less(a, b), spu_splats(0x80000000u)); }

/// The magnitude.
inline vec_float4 absolute(vec_float4 v) {
  return (vec_float4)spu_and((vec_uint4)v, spu_splats(0x7FFFFFFFu));
}

/// The largest of four numbers.
inline float largest_lane(vec_float4 v) {
  float largest = spu_extract(v, 0);
  for (int lane = 1; lane < 4; ++lane) {
    const float other = spu_extract(v, lane);
    if (other > largest) largest = other;
  }
  return largest;
}

}  // namespace softcell::spu
