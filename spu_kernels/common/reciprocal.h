#pragma once
// 1 / x, four at a time, by Newton's method from an estimate that costs one subtraction.
//
// spu_re() and one step would be as many instructions less on an SPU, but thirty more on a host, which has to
// look the estimate up in a table.

#include <spu_intrinsics.h>

namespace softcell::spu {

/// y := y (2 - x y): the relative error is squared.
inline vec_float4 sharpen_reciprocal(vec_float4 x, vec_float4 y) {
  return spu_madd(y, spu_nmsub(x, y, spu_splats(1.0f)), y);
}

/// 1 / x to a relative error of 3e-4, for normal x > 0 below 2^126. Negating the exponent by an integer
/// subtraction is right to 12 %.
inline vec_float4 rough_reciprocal(vec_float4 x) {
  const vec_float4 y = (vec_float4)spu_sub(spu_splats(0x7EF311C7u), (vec_uint4)x);
  return sharpen_reciprocal(x, sharpen_reciprocal(x, y));
}

/// 1 / x to a relative error of 4e-7, for the same x.
inline vec_float4 reciprocal(vec_float4 x) { return sharpen_reciprocal(x, rough_reciprocal(x)); }

}  // namespace softcell::spu
