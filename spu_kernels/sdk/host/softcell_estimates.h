#pragma once
// Reciprocal and reciprocal square root: the estimate by table, then one interpolation. Bit for bit the console's. [measured on
// consoles by the RPCS3 project, second-hand]
//
// An estimate is no plain float: sign and exponent, 13 bits of base, 10 bits of step; result = base - step * low bits of the argument.

#include "softcell_float.h"

namespace softcell_sdk {

/// base << 10 | step, by the top five fraction bits of the argument.
inline constexpr uint32_t kReciprocalTable[32] = {
    0x7FFBE0, 0x7F87A6, 0x70EF72, 0x708B40, 0x638B12, 0x633AEA, 0x5792C4, 0x574AA0, 0x4CCA7E, 0x4C9262, 0x430A44,
    0x42D62A, 0x3A2E12, 0x39FDFA, 0x3215E4, 0x31F1D2, 0x2AA9BE, 0x2A85AC, 0x23D59A, 0x23BD8E, 0x1D8576, 0x1D8576,
    0x17AD5A, 0x17AD5A, 0x124543, 0x124543, 0x0D392D, 0x0D392D, 0x08851A, 0x08851A, 0x041D07, 0x041D07};

/// Likewise; the lowest exponent bit of the argument comes first.
inline constexpr uint32_t kReciprocalSquareRootTable[64] = {
    0x350160, 0x34E954, 0x2F993D, 0x2F993D, 0x2AA523, 0x2AA523, 0x26190D, 0x26190D, 0x21E4F9, 0x21E4F9, 0x1E00E9,
    0x1E00E9, 0x1A5CD9, 0x1A5CD9, 0x16F8CB, 0x16F8CB, 0x13CCC0, 0x13CCC0, 0x10CCB3, 0x10CCB3, 0x0E00AA, 0x0E00AA,
    0x0B58A1, 0x0B58A1, 0x08D498, 0x08D498, 0x067491, 0x067491, 0x043089, 0x043089, 0x020C83, 0x020C83,
    0x7FFDF4, 0x7FD1DE, 0x7859C8, 0x783DBA, 0x71559C, 0x71559C, 0x6AE57C, 0x6AE57C, 0x64F561, 0x64F561, 0x5F7149,
    0x5F7149, 0x5A4D33, 0x5A4D33, 0x55811F, 0x55811F, 0x51050F, 0x51050F, 0x4CC8FE, 0x4CC8FE, 0x48D0F0, 0x48D0F0,
    0x4510E4, 0x4510E4, 0x4180D7, 0x4180D7, 0x3E24CC, 0x3E24CC, 0x3AF4C3, 0x3AF4C3, 0x37E8BA, 0x37E8BA};

inline Raw<int> look_up(const uint32_t* table, Raw<int> index) {
  return (Raw<int>)_mm_i32gather_epi32(reinterpret_cast<const int*>(table), (__m128i)index, 4);
}

/// frest: the sign of the argument, exponent 253 - e (0 for large arguments, 255 for zero). [SPU ISA, frest]
inline vec_float4 reciprocal_estimate(const vec_float4& a) {
  const Raw<int> bits = (Raw<int>)a.raw;
  const Raw<int> exponent = bits >> 23 & 0xFF, zero = exponent == 0;
  Raw<int> result = 253 - exponent;
  result &= result > 0;
  result = (result & ~zero) | (zero & 0xFF);
  const Raw<int> fraction = look_up(kReciprocalTable, bits >> 18 & 31);
  return vec_float4::from_raw((Raw<float>)((bits & INT32_MIN) | result << 23 | fraction));
}

/// frsqest: positive, exponent 190 - (e + 1) / 2, 255 for zero; the sign of the argument is ignored. [SPU ISA, frsqest]
inline vec_float4 reciprocal_square_root_estimate(const vec_float4& a) {
  const Raw<int> bits = (Raw<int>)a.raw;
  const Raw<int> exponent = bits >> 23 & 0xFF, zero = exponent == 0;
  const Raw<int> result = ((190 - ((exponent + 1) >> 1)) & ~zero) | (zero & 0xFF);
  const Raw<int> fraction = look_up(kReciprocalSquareRootTable, bits >> 18 & 63);
  return vec_float4::from_raw((Raw<float>)(result << 23 | fraction));
}

/// fi: sharpens an estimate with the argument's low fraction bits. [SPU ISA, fi]
inline vec_float4 interpolate(const vec_float4& argument, const vec_float4& estimate) {
  const Raw<unsigned int> a = (Raw<unsigned int>)argument.raw, e = (Raw<unsigned int>)estimate.raw;
  const Raw<unsigned int> base = (e & 0x7FFC00u) << 9, step = (e & 0x3FFu) * (a & 0x7FFFFu);
  const Raw<unsigned int> head = e & 0xFF800000u;
  const Raw<unsigned int> normal = head | (base - step) >> 9;
  // Only for an estimate that is not the argument's own: one binade down.
  const Raw<unsigned int> below = (head - 0x00800000u) | ((base - step) >> 8 & 0x7FFFFFu);
  const Raw<unsigned int> less = (Raw<unsigned int>)(step > base);
  return vec_float4::from_raw((Raw<float>)((below & less) | (normal & ~less)));
}

}  // namespace softcell_sdk

/// 1 / a to 12 bits.
inline vec_float4 spu_re(const vec_float4& a) { return softcell_sdk::interpolate(a, softcell_sdk::reciprocal_estimate(a)); }
/// 1 / sqrt(|a|) to 12 bits.
inline vec_float4 spu_rsqrte(const vec_float4& a) { return softcell_sdk::interpolate(a, softcell_sdk::reciprocal_square_root_estimate(a)); }
