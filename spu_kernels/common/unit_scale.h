#pragma once
// Scales the sum over a region from which its rotation is found, so that it is about one; or marks the sum as noise.

#include <spu_intrinsics.h>

#include "common/lane_mask.h"

namespace softcell::spu {

/// A sum is rounding noise if the sum of its elements' magnitudes, times `weight`, is at most `floor`.
struct RotationNoise {
  vec_float4 weight;
  vec_float4 floor;
};

/// Sums of magnitudes outside of this range count as noise, too.
constexpr float kLargestSum = 1.7e38f;
constexpr float kSmallestSum = 1e-37f;

struct UnitScale {
  vec_float4 by;    ///< a power of two that brings `sum` to 1..2; 0 where it is noise
  vec_uint4 noise;  ///< all ones where the sum is noise
};

/// @param sum  the sum of the magnitudes of all elements
__attribute__((always_inline)) inline UnitScale unit_scale(vec_float4 sum, const RotationNoise& noise_of) {
  const vec_uint4 exponent = spu_and((vec_uint4)sum, spu_splats(0x7F800000u));
  const vec_uint4 noise = negative_lanes(spu_or(
      less(spu_splats(kLargestSum), sum),
      spu_or(not_less(noise_of.floor, spu_mul(sum, noise_of.weight)), less(sum, spu_splats(kSmallestSum)))));
  return {(vec_float4)spu_andc(spu_sub(spu_splats(0x7F000000u), exponent), noise), noise};
}

}  // namespace softcell::spu
