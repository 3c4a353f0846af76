#pragma once
// The origin of a body: a point in the body to which its sums refer. If sums referred to the world's origin, they would lose all their
// digits far from there. The point is a multiple of a grid, a power of two, so that subtracting it is exact.

#include <spu_intrinsics.h>
#include <stdint.h>

namespace softcell::spu {

/// The sum of x[i] - base over `count` quadwords.
inline vec_float4 sum_of_differences(const vec_float4* x, uint32_t count, vec_float4 base) {
  vec_float4 sum0 = spu_splats(0.0f), sum1 = sum0, sum2 = sum0, sum3 = sum0;
  const uint32_t fours = count / 4 * 4;
  for (uint32_t i = 0; i < fours; i += 4) {
    sum0 = spu_add(sum0, spu_sub(x[i], base));
    sum1 = spu_add(sum1, spu_sub(x[i + 1], base));
    sum2 = spu_add(sum2, spu_sub(x[i + 2], base));
    sum3 = spu_add(sum3, spu_sub(x[i + 3], base));
  }
  for (uint32_t i = fours; i < count; ++i) sum0 = spu_add(sum0, spu_sub(x[i], base));
  return spu_add(spu_add(sum0, sum1), spu_add(sum2, sum3));
}

/// Each word rounded to a multiple of `grid`.
inline vec_float4 rounded_to_grid(vec_float4 v, float grid) {
  // 1.5 * 2^23 steps of the grid: a float of that size has no finer digits.
  const vec_float4 large = spu_splats(12582912.0f * grid);
  return spu_sub(spu_add(v, large), large);
}

}  // namespace softcell::spu
