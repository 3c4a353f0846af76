#pragma once
// Floating point. [SPU ISA, floating point; LEXT] documented
//
// Kernels run with the host's arithmetic truncating and flushing denormals, so one host instruction is one SPU instruction inside the range
// that both formats share. Results differ from an SPU's only
//   - at magnitudes of 2^128 and more, where the SPU goes on for one binade and the host stops at its largest number, and
//   - in the sign of a zero that comes from underflow, or from a sum of negative zeros: the SPU's zeros are positive.
// A product that is exactly zero is +0 here too: it is fused with an addition of +0, which costs nothing. Compares, conversions and estimates
// are integer arithmetic and right for every bit pattern, the SPU's extended range included. Doubles are the host's, truncating, where
// the SPU rounds to nearest unless told otherwise: kernels should not use them.

#include "softcell_integer.h"

// ---- single precision

inline vec_float4 spu_add(const vec_float4& a, const vec_float4& b) { return vec_float4::from_raw(_mm_add_ps(a.raw, b.raw)); }
inline vec_float4 spu_sub(const vec_float4& a, const vec_float4& b) { return vec_float4::from_raw(_mm_sub_ps(a.raw, b.raw)); }
inline vec_float4 spu_mul(const vec_float4& a, const vec_float4& b) {
  return vec_float4::from_raw(_mm_fmadd_ps(a.raw, b.raw, _mm_setzero_ps()));
}
/// a * b + c, rounded once.
inline vec_float4 spu_madd(const vec_float4& a, const vec_float4& b, const vec_float4& c) {
  return vec_float4::from_raw(_mm_fmadd_ps(a.raw, b.raw, c.raw));
}
/// a * b - c, rounded once.
inline vec_float4 spu_msub(const vec_float4& a, const vec_float4& b, const vec_float4& c) {
  return vec_float4::from_raw(_mm_fmsub_ps(a.raw, b.raw, c.raw));
}
/// c - a * b, rounded once.
inline vec_float4 spu_nmsub(const vec_float4& a, const vec_float4& b, const vec_float4& c) {
  return vec_float4::from_raw(_mm_fnmadd_ps(a.raw, b.raw, c.raw));
}

// ---- double precision

inline vec_double2 spu_add(const vec_double2& a, const vec_double2& b) { return vec_double2::from_raw(_mm_add_pd(a.raw, b.raw)); }
inline vec_double2 spu_sub(const vec_double2& a, const vec_double2& b) { return vec_double2::from_raw(_mm_sub_pd(a.raw, b.raw)); }
inline vec_double2 spu_mul(const vec_double2& a, const vec_double2& b) { return vec_double2::from_raw(_mm_mul_pd(a.raw, b.raw)); }
inline vec_double2 spu_madd(const vec_double2& a, const vec_double2& b, const vec_double2& c) {
  return vec_double2::from_raw(_mm_fmadd_pd(a.raw, b.raw, c.raw));
}
inline vec_double2 spu_msub(const vec_double2& a, const vec_double2& b, const vec_double2& c) {
  return vec_double2::from_raw(_mm_fmsub_pd(a.raw, b.raw, c.raw));
}
/// -(a * b - c): negated after rounding, so that a directed mode is not mirrored.
inline vec_double2 spu_nmsub(const vec_double2& a, const vec_double2& b, const vec_double2& c) {
  return vec_double2::from_raw(_mm_xor_pd(_mm_fmsub_pd(a.raw, b.raw, c.raw), _mm_set1_pd(-0.0)));
}
/// -(a * b + c), negated after rounding.
inline vec_double2 spu_nmadd(const vec_double2& a, const vec_double2& b, const vec_double2& c) {
  return vec_double2::from_raw(_mm_xor_pd(_mm_fmadd_pd(a.raw, b.raw, c.raw), _mm_set1_pd(-0.0)));
}

// ---- compares of floats: sign and magnitude as integers, after denormals became zero; all exponents are ordinary ones

namespace softcell_sdk {

inline Raw<int> magnitude_order(const vec_float4& v) {
  const Raw<int> magnitude = (Raw<int>)v.raw & 0x7FFFFFFF;
  return magnitude & (magnitude > 0x007FFFFF);
}
inline Raw<int> signed_order(const vec_float4& v) {
  const Raw<int> magnitude = magnitude_order(v), negative = (Raw<int>)v.raw >> 31;
  return (magnitude ^ negative) - negative;
}
inline vec_uint4 mask_of(Raw<int> mask) { return vec_uint4::from_raw((Raw<unsigned int>)mask); }

}  // namespace softcell_sdk

inline vec_uint4 spu_cmpeq(const vec_float4& a, const vec_float4& b) {
  return softcell_sdk::mask_of(softcell_sdk::signed_order(a) == softcell_sdk::signed_order(b));
}
inline vec_uint4 spu_cmpgt(const vec_float4& a, const vec_float4& b) {
  return softcell_sdk::mask_of(softcell_sdk::signed_order(a) > softcell_sdk::signed_order(b));
}
inline vec_uint4 spu_cmpabseq(const vec_float4& a, const vec_float4& b) {
  return softcell_sdk::mask_of(softcell_sdk::magnitude_order(a) == softcell_sdk::magnitude_order(b));
}
inline vec_uint4 spu_cmpabsgt(const vec_float4& a, const vec_float4& b) {
  return softcell_sdk::mask_of(softcell_sdk::magnitude_order(a) > softcell_sdk::magnitude_order(b));
}

// ---- conversions

namespace softcell_sdk {

inline uint32_t bits_of(float f) { return __builtin_bit_cast(uint32_t, f); }
inline float float_of(uint32_t bits) { return __builtin_bit_cast(float, bits); }

/// integer * 2^-scale as SPU bits, truncated. Exact in integers: no rounding mode enters.
inline float from_integer(uint32_t magnitude, bool negative, unsigned int scale) {
  if (magnitude == 0) return 0.0f;
  const int top = 31 - __builtin_clz(magnitude);
  const int exponent = top + 127 - static_cast<int>(scale);
  if (exponent <= 0) return 0.0f;
  const uint32_t fraction = (top > 23 ? magnitude >> (top - 23) : magnitude << (23 - top)) & 0x7FFFFFu;
  return float_of((negative ? 0x80000000u : 0u) | static_cast<uint32_t>(exponent) << 23 | fraction);
}

/// |value| * 2^scale truncated to an integer, or 2^32 where that or more comes out.
inline uint64_t to_integer(float value, unsigned int scale) {
  const uint32_t bits = bits_of(value);
  const int exponent = static_cast<int>(bits >> 23 & 0xFFu);
  if (exponent == 0) return 0;
  const uint64_t fraction = (bits & 0x7FFFFFu) | 0x800000u;
  const int shift = exponent - 150 + static_cast<int>(scale);
  if (shift > 9) return uint64_t{1} << 32;
  const uint64_t result = shift >= 0 ? fraction << shift : shift > -24 ? fraction >> -shift : 0;
  return result;
}

inline int saturated(float value, unsigned int scale) {
  const uint64_t magnitude = to_integer(value, scale);
  if ((bits_of(value) & 0x80000000u) != 0) return magnitude >= 0x80000000u ? INT32_MIN : -static_cast<int>(magnitude);
  return magnitude > 0x7FFFFFFFu ? INT32_MAX : static_cast<int>(magnitude);
}
inline unsigned int saturated_unsigned(float value, unsigned int scale) {
  if ((bits_of(value) & 0x80000000u) != 0) return 0;
  const uint64_t magnitude = to_integer(value, scale);
  return magnitude > 0xFFFFFFFFu ? 0xFFFFFFFFu : static_cast<unsigned int>(magnitude);
}

/// The scale of a conversion is part of the instruction.
constexpr bool is_scale(int scale) { return scale >= 0 && scale <= 127; }

}  // namespace softcell_sdk

/// Integer to float: value / 2^scale.
inline vec_float4 spu_convtf(const vec_int4& a, unsigned int scale) {
  return softcell_sdk::for_lanes<vec_float4>(
      [scale](int x) { return softcell_sdk::from_integer(x < 0 ? 0u - static_cast<uint32_t>(x) : static_cast<uint32_t>(x), x < 0, scale); }, a);
}
inline vec_float4 spu_convtf(const vec_uint4& a, unsigned int scale) {
  return softcell_sdk::for_lanes<vec_float4>([scale](uint32_t x) { return softcell_sdk::from_integer(x, false, scale); }, a);
}
/// Float to integer: value * 2^scale, truncated and clamped.
inline vec_int4 spu_convts(const vec_float4& a, unsigned int scale) {
  return softcell_sdk::for_lanes<vec_int4>([scale](float x) { return softcell_sdk::saturated(x, scale); }, a);
}
inline vec_uint4 spu_convtu(const vec_float4& a, unsigned int scale) {
  return softcell_sdk::for_lanes<vec_uint4>([scale](float x) { return softcell_sdk::saturated_unsigned(x, scale); }, a);
}
/// Words 0 and 2 to doubles; denormals are zero, an exponent of all ones is infinity or a NaN.
inline vec_double2 spu_extend(const vec_float4& a) {
  return vec_double2(static_cast<double>(a.raw[0]), static_cast<double>(a.raw[2]));
}
/// Doubles to words 0 and 2; words 1 and 3 are 0.
inline vec_float4 spu_roundtf(const vec_double2& a) {
  return vec_float4(static_cast<float>(a.raw[0]), 0.0f, static_cast<float>(a.raw[1]), 0.0f);
}
