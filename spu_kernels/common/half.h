#pragma once
// Rounds four floats to four half floats (binary16): to the nearest, ties away from zero. Uses integer
// arithmetic, since the SPU's floating point truncates. (Ties to even would take three operations more for
// each, and be no more accurate.)

#include <spu_intrinsics.h>

namespace softcell::spu {

/// Bits of the smallest float that is a normal binary16, and of the smallest that rounds to infinity.
constexpr unsigned int kHalfSmallestNormal = 0x38800000u;  // 2^-14
constexpr unsigned int kHalfOverflow = 0x477FF000u;        // 65520

/// binary16 bits in the high half of each word; the low half holds bits of the fraction that do not count. For values from
/// 2^-14, the smallest normal binary16, to below kHalfOverflow.
inline vec_uint4 high_half_of_positive(vec_float4 value) {
  // Rebias the exponent (127 to 15) and round in one addition; a carry out of the fraction moves the
  // exponent, as it should.
  return spu_sl(spu_add((vec_uint4)value, spu_splats(0x1000u - (112u << 23))), 3);
}

/// A float times this has the exponent of a binary16. It is flushed to zero if it is too small for a normal binary16.
constexpr float kHalfRebias = 0x1p-112f;

/// The same for either sign, of a value times kHalfRebias. Values too small for a normal binary16 become +0.
/// For magnitudes below kHalfOverflow.
inline vec_uint4 high_half_of_rebiased(vec_float4 rebiased) {
#ifdef __SPU__  // an SPU flushes products to +0
  const vec_uint4 bits = (vec_uint4)rebiased;
#else  // a host flushes them to a zero with a sign; the addition makes it +0
  const vec_uint4 bits = (vec_uint4)spu_add(rebiased, spu_splats(0.0f));
#endif
  const vec_uint4 rounded = spu_add(bits, spu_splats(0x1000u));
  return spu_sel(spu_sl(rounded, 3), bits, spu_splats(0x80000000u));
}

/// The same for a value that was not multiplied.
inline vec_uint4 high_half_or_zero(vec_float4 value) {
  return high_half_of_rebiased(spu_mul(value, spu_splats(kHalfRebias)));
}

/// binary16 bits in the high half of each word, the low half 0, for every bit pattern: subnormals, zero,
/// infinity; a NaN stays a NaN. The code is long and seldom needed, so it is not inlined.
__attribute__((noinline)) inline vec_uint4 high_half_of_any(vec_float4 value) {
  const vec_uint4 bits = (vec_uint4)value;
  const vec_uint4 magnitude = spu_and(bits, spu_splats(0x7FFFFFFFu));
  const vec_uint4 sign = spu_and(spu_rlmask(bits, -16), spu_splats(0x8000u));

  // Below 2^-14: shift the fraction with its hidden bit right by 14..25 places and round. A shift by 25 gives 0.
  const vec_uint4 exponent = spu_rlmask(magnitude, -23);
  const vec_uint4 wanted = spu_sub(spu_splats(126u), exponent);
  const vec_uint4 shift = spu_sel(wanted, spu_splats(25u), spu_cmpgt(wanted, spu_splats(25u)));
  const vec_int4 right = (vec_int4)spu_sub(spu_splats(0u), shift);
  const vec_uint4 fraction = spu_or(spu_and(magnitude, spu_splats(0x7FFFFFu)), spu_splats(0x800000u));
  const vec_uint4 half_unit = spu_sl(spu_splats(1u), spu_sub(shift, spu_splats(1u)));
  const vec_uint4 subnormal = spu_rlmask(spu_add(fraction, half_unit), right);

  // A NaN keeps the high bits of its payload. If these are 0 it gets the quiet bit, or it would become infinity.
  const vec_uint4 infinity = spu_splats(0x7C00u);
  const vec_uint4 payload = spu_and(spu_rlmask(magnitude, -13), spu_splats(0x3FFu));
  const vec_uint4 quiet = spu_and(spu_cmpeq(payload, spu_splats(0u)), spu_splats(0x200u));
  const vec_uint4 nan = spu_or(spu_or(infinity, payload), quiet);

  vec_uint4 half = spu_rlmask(high_half_or_zero(value), -16);
  half = spu_sel(half, spu_or(sign, subnormal), spu_cmpgt(spu_splats(kHalfSmallestNormal), magnitude));
  half = spu_sel(half, spu_or(sign, infinity), spu_cmpgt(magnitude, spu_splats(kHalfOverflow - 1u)));
  return spu_sl(spu_sel(half, spu_or(sign, nan), spu_cmpgt(magnitude, spu_splats(0x7F800000u))), 16);
}

}  // namespace softcell::spu
