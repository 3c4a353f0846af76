#pragma once
// Between integers, floats and doubles.  [SPU-ISA, conversions] documented
//
// The scale of a conversion is a constant 0..127 in the instruction, so these are macros, as in a real SPU
// compiler's headers: a compound literal with commas as argument needs parentheses. Nothing here depends on
// the rounding mode.

#include "softcell_double.h"
#include "softcell_single.h"

namespace softcell_sdk {

constexpr bool is_scale(long long scale) { return scale >= 0 && scale <= 127; }

// The scale as a number, for C: what is constant where it is called is folded as well.

/// magnitude / 2^scale, truncated to 24 bits. Below the smallest normal float it is zero.
SC_SDK_INLINE Raw<unsigned int> scaled_float(Raw<unsigned int> magnitude, int scale) {
  // Everything below the 24 leading bits goes first, so that no conversion that follows has anything to
  // round.
  Raw<unsigned int> surplus = magnitude >> 24;
  surplus |= surplus >> 1;
  surplus |= surplus >> 2;
  surplus |= surplus >> 4;
  const __m128i exact = (__m128i)(magnitude & ~surplus);
  const __m128 high = _mm_cvtepi32_ps(_mm_srli_epi32(exact, 16));
  const __m128 low = _mm_cvtepi32_ps(_mm_and_si128(exact, _mm_set1_epi32(0xFFFF)));
  const auto value = (Raw<unsigned int>)_mm_fmadd_ps(high, _mm_set1_ps(65536.0f), low);
  const auto representable = (Raw<unsigned int>)(value >> 23 > static_cast<unsigned int>(scale));
  return (value - (static_cast<unsigned int>(scale) << 23)) & representable;
}

SC_SDK_INLINE vec_float4 to_float_by(vec_uint4 a_, int scale) {
  return make<vec_float4>(scaled_float(a_.raw, scale));
}
SC_SDK_INLINE vec_float4 to_float_by(vec_int4 a_, int scale) {
  const auto sign = (Raw<unsigned int>)(a_.raw >> 31), magnitude = ((Raw<unsigned int>)a_.raw ^ sign) - sign;
  const Raw<unsigned int> value = scaled_float(magnitude, scale);
  return make<vec_float4>(value | (sign & (Raw<unsigned int>)(value != 0) & 0x80000000u));
}

/// A float times 2^scale: its exponent field after scaling, and the value where that fits a signed word.
struct Scaled {
  Raw<int> exponent;   ///< of the product; -1 for zero and denormals
  Raw<int> truncated;  ///< the product's integer part where exponent < 127 + 31; sign included
};
SC_SDK_INLINE Scaled scale_up(vec_float4 a_, int scale) {
  const auto word = (Raw<unsigned int>)a_.raw;
  const auto field = (Raw<int>)(word >> 23 & 0xFFu), zero = (Raw<int>)(field == 0);
  const Raw<int> exponent = (field + scale) | zero;
  const auto fits = (Raw<unsigned int>)(~zero & (exponent < 127 + 31));
  const auto product = (__m128)((word + (static_cast<unsigned int>(scale) << 23)) & fits);
  return {exponent, (Raw<int>)_mm_cvttps_epi32(product)};
}

SC_SDK_INLINE vec_int4 to_signed_by(vec_float4 a_, int scale) {
  const Scaled s_ = scale_up(a_, scale);
  const Raw<int> over = s_.exponent >= 127 + 31, most = ((Raw<int>)a_.raw >> 31) ^ INT32_MAX;
  return make<vec_int4>((s_.truncated & ~over) | (most & over));
}
SC_SDK_INLINE vec_uint4 to_unsigned_by(vec_float4 a_, int scale) {
  const Scaled s_ = scale_up(a_, scale);
  // From 2^31 to 2^32 the 24 bits of the fraction are the top of the word.
  const Raw<int> top = s_.exponent == 127 + 31, over = s_.exponent > 127 + 31;
  const auto shifted = (Raw<int>)((Raw<unsigned int>)a_.raw << 8 | 0x80000000u);
  const Raw<int> positive = ~((Raw<int>)a_.raw >> 31);
  return make<vec_uint4>((s_.truncated | (shifted & top) | over) & positive);
}

template <int Scale, class V_>
SC_SDK_INLINE vec_float4 to_float(V_ a_) {
  static_assert(is_scale(Scale), "spu_convtf takes a scale from 0 to 127");
  return to_float_by(a_, Scale);
}
template <int Scale>
SC_SDK_INLINE vec_int4 to_signed(vec_float4 a_) {
  static_assert(is_scale(Scale), "spu_convts takes a scale from 0 to 127");
  return to_signed_by(a_, Scale);
}
template <int Scale>
SC_SDK_INLINE vec_uint4 to_unsigned(vec_float4 a_) {
  static_assert(is_scale(Scale), "spu_convtu takes a scale from 0 to 127");
  return to_unsigned_by(a_, Scale);
}

}  // namespace softcell_sdk

/// Integers to floats: value / 2^scale, truncated.
#define spu_convtf(ra, scale) (softcell_sdk::to_float<(scale)>(ra))
/// Floats to integers: value * 2^scale, truncated, clamped to what the lane holds.
#define spu_convts(ra, scale) (softcell_sdk::to_signed<(scale)>(ra))
#define spu_convtu(ra, scale) (softcell_sdk::to_unsigned<(scale)>(ra))

/// Words 0 and 2 to doubles. Denormals are zero; an exponent of all ones is infinity or NaN here, unlike in
/// single precision.
SC_SDK_INLINE vec_double2 spu_extend(vec_float4 a_) {
  using namespace softcell_sdk;
  const Raw<int> field = (Raw<int>)a_.raw & 0x7F800000;
  const auto flushed_lanes = (__m128)((Raw<int>)a_.raw & ((field != 0) | INT32_MIN));
  return one_nan(_mm_cvtps_pd(_mm_shuffle_ps(flushed_lanes, flushed_lanes, 0x08)));
}

/// Doubles to words 0 and 2, rounded to nearest even; words 1 and 3 are 0. Results below the smallest normal
/// float are kept as denormals (the SPU's own behaviour is assumed), which single precision reads as zero
/// anyway.
SC_SDK_INLINE vec_float4 spu_roundtf(vec_double2 a_) {
  using namespace softcell_sdk;
  const auto lanes = (Raw<int>)_mm_unpacklo_ps(to_single(a_), zero_floats());
  const Raw<int> nan = (lanes & INT32_MAX) > 0x7F800000;
  return make<vec_float4>((lanes & ~nan) | (nan & 0x7FC00000));
}
