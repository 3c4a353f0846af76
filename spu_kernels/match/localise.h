#pragma once
// Positions about a point in the body, and whether they are numbers at all.
//
// Far from the world's origin the sums of m~ x x0^T would cancel to nothing. The point is a multiple of the
// plan's grid, a power of two, so that subtracting it is exact.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "common/lane_mask.h"
#include "common/transpose.h"
#include "match/local_store.h"

namespace softcell::spu {

/// A quadword to a particle, as they come from main memory.
inline vec_float4* particle_quadwords(Vectors4* groups) { return reinterpret_cast<vec_float4*>(groups); }

/// Adds to `bad` the sign bits of words that are infinite or no numbers.
inline vec_uint4 note_bad(vec_uint4 bad, vec_float4 v) {
  const vec_uint4 magnitude = spu_and((vec_uint4)v, spu_splats(0x7FFFFFFFu));
  return spu_or(bad, spu_add(magnitude, spu_splats(0x00800000u)));
}

/// Whether all of `count` quadwords are finite.
inline bool all_finite(const vec_float4* v, uint32_t count) {
  vec_uint4 bad = spu_splats(0u);
  for (uint32_t i = 0; i < count; ++i) bad = note_bad(bad, v[i]);
  return !any_negative(bad);
}

/// The mean of `count` positions, a quadword each, rounded to the grid.
inline vec_float4 origin_of(const vec_float4* x, uint32_t count, float grid) {
  const vec_float4 base = x[0];
  vec_float4 sum0 = spu_splats(0.0f), sum1 = sum0, sum2 = sum0, sum3 = sum0;
  uint32_t i = 0;
  for (; i + 4 <= count; i += 4) {
    sum0 = spu_add(sum0, spu_sub(x[i], base));
    sum1 = spu_add(sum1, spu_sub(x[i + 1], base));
    sum2 = spu_add(sum2, spu_sub(x[i + 2], base));
    sum3 = spu_add(sum3, spu_sub(x[i + 3], base));
  }
  for (; i < count; ++i) sum0 = spu_add(sum0, spu_sub(x[i], base));
  const vec_float4 sum = spu_add(spu_add(sum0, sum1), spu_add(sum2, sum3));
  const vec_float4 mean = spu_madd(sum, spu_splats(1.0f / static_cast<float>(count)), base);
  // 1.5 * 2^23 steps of the grid: a float of that size has no finer digits.
  const vec_float4 large = spu_splats(12582912.0f * grid);
  return spu_sub(spu_add(mean, large), large);
}

/// Turns groups of four quadwords, a particle each, into groups of components, `origin` subtracted. Lanes
/// past `count` become zero.
inline void to_components(Vectors4* groups, uint32_t count, vec_float4 origin) {
  vec_float4* const x = particle_quadwords(groups);
  const uint32_t group_count = groups_of(count);
  for (uint32_t i = count; i < 4 * group_count; ++i) x[i] = origin;
  for (uint32_t g = 0; g < group_count; ++g) {
    const Rows4 t = transpose({spu_sub(x[4 * g], origin), spu_sub(x[4 * g + 1], origin),
                               spu_sub(x[4 * g + 2], origin), spu_sub(x[4 * g + 3], origin)});
    groups[g].v = {t.a, t.b, t.c};
  }
}

/// Back again: a quadword to a particle, its fourth word zero.
inline void to_particles(Vectors4* groups, uint32_t group_count) {
  vec_float4* const x = particle_quadwords(groups);
  for (uint32_t g = 0; g < group_count; ++g) {
    const Vector3x4 v = groups[g].v;
    const Rows4 t = transpose({v.x, v.y, v.z, spu_splats(0.0f)});
    x[4 * g] = t.a;
    x[4 * g + 1] = t.b;
    x[4 * g + 2] = t.c;
    x[4 * g + 3] = t.d;
  }
}

}  // namespace softcell::spu
