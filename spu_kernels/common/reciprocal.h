#pragma once
// 1 / x and 1 / sqrt(x), four at a time, by Newton's method from an estimate that costs one subtraction.
//
// With spu_re() or spu_rsqrte() and one step an SPU would need some instructions less, but a host thirty more, because it looks these
// estimates up in a table.

#include <spu_intrinsics.h>

namespace softcell::spu {

/// y := y (2 - x y): the relative error is squared.
inline vec_float4 sharpen_reciprocal(vec_float4 x, vec_float4 y) {
  return spu_madd(y, spu_nmsub(x, y, spu_splats(1.0f)), y);
}

/// 1 / x to a relative error of 3e-4, for normal x > 0 below 2^126. It begins with an integer subtraction, which negates the exponent and
/// is right to within 12 %.
inline vec_float4 rough_reciprocal(vec_float4 x) {
  const vec_float4 y = (vec_float4)spu_sub(spu_splats(0x7EF311C7u), (vec_uint4)x);
  return sharpen_reciprocal(x, sharpen_reciprocal(x, y));
}

/// 1 / x to a relative error of 4e-7, for the same x.
inline vec_float4 reciprocal(vec_float4 x) { return sharpen_reciprocal(x, rough_reciprocal(x)); }

/// 1 / sqrt(x) for normal x > 0, relative error below 5e-6: enough for a vector that is rounded to halves.
/// It begins with an integer shift, which halves the exponent and is right to within 3.5 %; each of two Newton steps squares the error.
inline vec_float4 reciprocal_sqrt(vec_float4 x) {
  const vec_float4 half_x = spu_mul(x, spu_splats(0.5f));
  const vec_float4 y0 = (vec_float4)spu_sub(spu_splats(0x5F375A86u), spu_rlmask((vec_uint4)x, -1));
  const vec_float4 y1 = spu_mul(y0, spu_nmsub(spu_mul(half_x, y0), y0, spu_splats(1.5f)));
  return spu_mul(y1, spu_nmsub(spu_mul(half_x, y1), y1, spu_splats(1.5f)));
}

/// scale / sqrt(x) for normal x > 0, relative error below 3e-5: a tenth of the error of rounding a unit vector to
/// halves. It begins with the same estimate y. r = x y^2 is within 7 % of one, and there 1 / sqrt(r) is nearly the parabola
/// 0.375 r^2 - 1.251106 r + 1.876106 (the one with the smallest greatest error). That takes a chain of five operations instead of seven.
/// @param scale  a constant power of two; it costs nothing here and changes only the exponent
inline vec_float4 rough_reciprocal_sqrt(vec_float4 x, float scale = 1) {
  const vec_float4 y = (vec_float4)spu_sub(spu_splats(0x5F375A86u), spu_rlmask((vec_uint4)x, -1));
  const vec_float4 r = spu_mul(x, spu_mul(y, y));
  const vec_float4 slope = spu_madd(spu_splats(0.375f * scale), r, spu_splats(-0x1.40487cp0f * scale));
  return spu_mul(y, spu_madd(slope, r, spu_splats(0x1.e0487cp0f * scale)));
}

}  // namespace softcell::spu
