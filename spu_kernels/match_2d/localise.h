#pragma once
// Makes positions relative to a point in the body, and turns pairs of particles into components in lanes.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "common/origin.h"
#include "common/transpose.h"
#include "match_2d/local_store.h"

namespace softcell::spu {

/// The same memory with one quadword for each two particles, as it comes from main memory.
inline vec_float4* particle_pairs(Vector2x4* groups) { return reinterpret_cast<vec_float4*>(groups); }

/// x0 y0 x0 y0, and x1 y1 x1 y1.
inline vec_float4 first_of_pair(vec_float4 pair) {
  const vec_uchar16 low = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
  return spu_shuffle(pair, pair, low);
}
inline vec_float4 second_of_pair(vec_float4 pair) {
  const vec_uchar16 high = {8, 9, 10, 11, 12, 13, 14, 15, 8, 9, 10, 11, 12, 13, 14, 15};
  return spu_shuffle(pair, pair, high);
}

/// Sets the particles past `count` in the last group. @param v  their value, twice
inline void pad_pairs(vec_float4* pairs, uint32_t count, vec_float4 v) {
  const vec_uchar16 keep_first = {0, 1, 2, 3, 4, 5, 6, 7, 24, 25, 26, 27, 28, 29, 30, 31};
  if (count % 2 != 0) pairs[count / 2] = spu_shuffle(pairs[count / 2], v, keep_first);
  for (uint32_t i = (count + 1) / 2; i < 2 * groups_of(count); ++i) pairs[i] = v;
}

/// The mean of `count` positions, rounded to the grid, twice in a quadword. @pre  the last group is padded with the first position
/// @param inverse_count  1 / count
inline vec_float4 origin_of_pairs(const vec_float4* pairs, uint32_t count, float inverse_count, float grid) {
  const vec_float4 base = first_of_pair(pairs[0]);
  const vec_float4 sum = sum_of_differences(pairs, 2 * groups_of(count), base);
  const vec_float4 both = spu_add(first_of_pair(sum), second_of_pair(sum));
  return rounded_to_grid(spu_madd(both, spu_splats(inverse_count), base), grid);
}

/// Two quadwords of pairs, minus `origin`, as components.
inline Vector2x4 components_of(vec_float4 first, vec_float4 second, vec_float4 origin) {
  const vec_uchar16 even = {0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27};
  const vec_uchar16 odd = {4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31};
  const vec_float4 a = spu_sub(first, origin), b = spu_sub(second, origin);
  return {spu_shuffle(a, b, even), spu_shuffle(a, b, odd)};
}

/// Turns groups of pairs into groups of components, and subtracts `origin`.
inline void to_components(Vector2x4* groups, uint32_t group_count, vec_float4 origin) {
  for (uint32_t g = 0; g < group_count; ++g) groups[g] = components_of(groups[g].x, groups[g].y, origin);
}

/// Turns groups of components back into groups of pairs.
inline void to_pairs(Vector2x4* groups, uint32_t group_count) {
  for (uint32_t g = 0; g < group_count; ++g) {
    const Vector2x4 v = groups[g];
    groups[g] = {interleave_low(v.x, v.y), interleave_high(v.x, v.y)};
  }
}

}  // namespace softcell::spu
