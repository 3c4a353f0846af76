#pragma once
// Tests whether floats are finite.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "common/lane_mask.h"

namespace softcell::spu {

/// Sets the sign bits of `bad` for words that are not finite.
inline vec_uint4 note_bad(vec_uint4 bad, vec_float4 v) {
  const vec_uint4 magnitude = spu_and((vec_uint4)v, spu_splats(0x7FFFFFFFu));
  return spu_or(bad, spu_add(magnitude, spu_splats(0x00800000u)));
}

/// True if all of `count` quadwords are finite.
inline bool all_finite(const vec_float4* v, uint32_t count) {
  vec_uint4 bad = spu_splats(0u);
  for (uint32_t i = 0; i < count; ++i) bad = note_bad(bad, v[i]);
  return !any_negative(bad);
}

}  // namespace softcell::spu
