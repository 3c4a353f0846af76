#pragma once
// Makes positions relative to a point in the body, and transposes particles' records to components in lanes.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "common/origin.h"
#include "common/transpose.h"
#include "match/local_store.h"

namespace softcell::spu {

/// The same memory with one quadword for each particle, as it comes from main memory.
inline vec_float4* particle_quadwords(Vectors4* groups) { return reinterpret_cast<vec_float4*>(groups); }

/// The mean of kMatchSamples positions, a quadword each, rounded to the grid.
inline vec_float4 origin_of(const vec_float4* x, float grid) {
  constexpr float kShare = 1.0f / kMatchSamples;
  const vec_float4 sum = sum_of_differences(x, kMatchSamples, x[0]);
  return rounded_to_grid(spu_madd(sum, spu_splats(kShare), x[0]), grid);
}

/// Transposes groups of four particles to groups of components, and subtracts `origin`. Lanes
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

/// Transposes back, to one quadword for each particle, whose fourth word is zero.
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
