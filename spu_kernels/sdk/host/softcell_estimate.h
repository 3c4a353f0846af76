#pragma once
// Reciprocal and reciprocal square root: an estimate from a table, sharpened by one interpolation. Bit for
// bit the console's. [read off PS3 hardware by the RPCS3 project] second-hand
//
// An estimate is no plain float: below sign and exponent stand 13 bits of base and 10 bits of step, and the
// interpolation computes base - step * (low 19 fraction bits of the argument).

#include "softcell_single.h"

namespace softcell_sdk {

/// base << 10 | step, by the top five fraction bits of the argument.
inline constexpr int kReciprocalTable[32] = {
    0x7FFBE0, 0x7F87A6, 0x70EF72, 0x708B40, 0x638B12, 0x633AEA, 0x5792C4, 0x574AA0,
    0x4CCA7E, 0x4C9262, 0x430A44, 0x42D62A, 0x3A2E12, 0x39FDFA, 0x3215E4, 0x31F1D2,
    0x2AA9BE, 0x2A85AC, 0x23D59A, 0x23BD8E, 0x1D8576, 0x1D8576, 0x17AD5A, 0x17AD5A,
    0x124543, 0x124543, 0x0D392D, 0x0D392D, 0x08851A, 0x08851A, 0x041D07, 0x041D07};

/// Likewise, by the lowest exponent bit and the top five fraction bits.
inline constexpr int kReciprocalSquareRootTable[64] = {
    0x350160, 0x34E954, 0x2F993D, 0x2F993D, 0x2AA523, 0x2AA523, 0x26190D, 0x26190D, 0x21E4F9, 0x21E4F9,
    0x1E00E9, 0x1E00E9, 0x1A5CD9, 0x1A5CD9, 0x16F8CB, 0x16F8CB, 0x13CCC0, 0x13CCC0, 0x10CCB3, 0x10CCB3,
    0x0E00AA, 0x0E00AA, 0x0B58A1, 0x0B58A1, 0x08D498, 0x08D498, 0x067491, 0x067491, 0x043089, 0x043089,
    0x020C83, 0x020C83, 0x7FFDF4, 0x7FD1DE, 0x7859C8, 0x783DBA, 0x71559C, 0x71559C, 0x6AE57C, 0x6AE57C,
    0x64F561, 0x64F561, 0x5F7149, 0x5F7149, 0x5A4D33, 0x5A4D33, 0x55811F, 0x55811F, 0x51050F, 0x51050F,
    0x4CC8FE, 0x4CC8FE, 0x48D0F0, 0x48D0F0, 0x4510E4, 0x4510E4, 0x4180D7, 0x4180D7, 0x3E24CC, 0x3E24CC,
    0x3AF4C3, 0x3AF4C3, 0x37E8BA, 0x37E8BA};

SC_SDK_INLINE Raw<int> look_up(const int* table, Raw<int> index) {
  return (Raw<int>)_mm_i32gather_epi32(table, (__m128i)index, 4);
}

/// frest: the argument's sign; exponent 253 - e, 0 where that is negative, 255 for zero.
SC_SDK_INLINE vec_float4 reciprocal_estimate(vec_float4 a_) {
  const auto word = (Raw<int>)a_.raw;
  const Raw<int> field = word >> 23 & 0xFF, zero = field == 0, normal = 253 - field;
  const Raw<int> exponent = (normal & (normal > 0) & ~zero) | (zero & 0xFF);
  return make<vec_float4>((word & INT32_MIN) | exponent << 23 | look_up(kReciprocalTable, word >> 18 & 31));
}

/// frsqest: positive; exponent 190 - (e + 1) / 2, 255 for zero. The argument's sign is ignored.
SC_SDK_INLINE vec_float4 reciprocal_square_root_estimate(vec_float4 a_) {
  const auto word = (Raw<int>)a_.raw;
  const Raw<int> field = word >> 23 & 0xFF, zero = field == 0;
  const Raw<int> exponent = ((190 - ((field + 1) >> 1)) & ~zero) | (zero & 0xFF);
  return make<vec_float4>(exponent << 23 | look_up(kReciprocalSquareRootTable, word >> 18 & 63));
}

/// fi: sharpens an estimate with the argument's low fraction bits.
SC_SDK_INLINE vec_float4 interpolate(vec_float4 argument, vec_float4 estimate) {
  const auto a_ = (Raw<unsigned int>)argument.raw, e_ = (Raw<unsigned int>)estimate.raw;
  const Raw<unsigned int> base = (e_ & 0x7FFC00u) << 9, product = (e_ & 0x3FFu) * (a_ & 0x7FFFFu),
                          head = e_ & 0xFF800000u;
  const Raw<unsigned int> difference = base - product;
  // One binade down: only for an estimate that is not the argument's own.
  const auto borrowed = (Raw<unsigned int>)(product > base);
  const Raw<unsigned int> below = (head - 0x00800000u) | (difference >> 8 & 0x7FFFFFu);
  return make<vec_float4>((below & borrowed) | ((head | difference >> 9) & ~borrowed));
}

/// fi on an argument's own estimate: its product never passes its base (a test tries every one), so there is
/// no borrow.
SC_SDK_INLINE vec_float4 interpolate_own(vec_float4 argument, vec_float4 estimate) {
  const auto a_ = (Raw<unsigned int>)argument.raw, e_ = (Raw<unsigned int>)estimate.raw;
  const Raw<unsigned int> base = (e_ & 0x7FFC00u) << 9, product = (e_ & 0x3FFu) * (a_ & 0x7FFFFu);
  return make<vec_float4>((e_ & 0xFF800000u) | (base - product) >> 9);
}

}  // namespace softcell_sdk

/// 1 / a to 12 bits.
SC_SDK_INLINE vec_float4 spu_re(vec_float4 a_) {
  return softcell_sdk::interpolate_own(a_, softcell_sdk::reciprocal_estimate(a_));
}
/// 1 / sqrt(|a|) to 12 bits.
SC_SDK_INLINE vec_float4 spu_rsqrte(vec_float4 a_) {
  return softcell_sdk::interpolate_own(a_, softcell_sdk::reciprocal_square_root_estimate(a_));
}
