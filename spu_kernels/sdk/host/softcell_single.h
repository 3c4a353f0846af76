#pragma once
// Single precision: arithmetic and compares.  [SPU-ISA, floating point] documented
//
// Kernels run with the host's arithmetic truncating, denormal operands and results flushed to zero. Inside
// the range that both formats share, one host instruction is one SPU instruction. Arithmetic differs from an
// SPU's in these cases only:
//
//   - a magnitude of 2^128 or more, as operand or exact result: the SPU has one ordinary binade more and
//     saturates at 0x7FFFFFFF; the host stops at 0x7F7FFFFF, and takes those operands for infinities and
//     NaNs;
//   - the sign of a zero that comes from underflow, or from adding nothing but negative zeros: the SPU's
//     zeros are positive;
//   - constants that are denormal: a compiler may compute with them before the program runs, without
//     flushing.
//
// A product that is exactly zero is +0 as on the SPU, since it is fused with an addition of +0. Compares,
// conversions and estimates (here and in softcell_convert.h, softcell_estimate.h) work on integers and are
// right for every bit pattern.

#include "softcell_lanes.h"

SC_SDK_INLINE vec_float4 spu_add(vec_float4 a_, vec_float4 b_) {
  return softcell_sdk::make<vec_float4>(_mm_add_ps(a_.raw, b_.raw));
}
SC_SDK_INLINE vec_float4 spu_sub(vec_float4 a_, vec_float4 b_) {
  return softcell_sdk::make<vec_float4>(_mm_sub_ps(a_.raw, b_.raw));
}
SC_SDK_INLINE vec_float4 spu_mul(vec_float4 a_, vec_float4 b_) {
  return softcell_sdk::make<vec_float4>(_mm_fmadd_ps(a_.raw, b_.raw, softcell_sdk::zero_floats()));
}
/// a * b + c, rounded once.
SC_SDK_INLINE vec_float4 spu_madd(vec_float4 a_, vec_float4 b_, vec_float4 c_) {
  return softcell_sdk::make<vec_float4>(_mm_fmadd_ps(a_.raw, b_.raw, c_.raw));
}
/// a * b - c, rounded once.
SC_SDK_INLINE vec_float4 spu_msub(vec_float4 a_, vec_float4 b_, vec_float4 c_) {
  return softcell_sdk::make<vec_float4>(_mm_fmsub_ps(a_.raw, b_.raw, c_.raw));
}
/// c - a * b, rounded once.
SC_SDK_INLINE vec_float4 spu_nmsub(vec_float4 a_, vec_float4 b_, vec_float4 c_) {
  return softcell_sdk::make<vec_float4>(_mm_fnmadd_ps(a_.raw, b_.raw, c_.raw));
}

namespace softcell_sdk {

// Floats as integers of the same order. Denormals are zero, and an exponent of 255 is one like any other.

SC_SDK_INLINE Raw<int> magnitude_order(vec_float4 v_) {
  const Raw<int> magnitude = (Raw<int>)v_.raw & 0x7FFFFFFF;
  return magnitude & (magnitude > 0x007FFFFF);
}
SC_SDK_INLINE Raw<int> signed_order(vec_float4 v_) {
  const Raw<int> magnitude = magnitude_order(v_), negative = (Raw<int>)v_.raw >> 31;
  return (magnitude ^ negative) - negative;
}

}  // namespace softcell_sdk

SC_SDK_INLINE vec_uint4 spu_cmpeq(vec_float4 a_, vec_float4 b_) {
  return softcell_sdk::make<vec_uint4>(softcell_sdk::signed_order(a_) == softcell_sdk::signed_order(b_));
}
SC_SDK_INLINE vec_uint4 spu_cmpgt(vec_float4 a_, vec_float4 b_) {
  return softcell_sdk::make<vec_uint4>(softcell_sdk::signed_order(a_) > softcell_sdk::signed_order(b_));
}
/// Of magnitudes.
SC_SDK_INLINE vec_uint4 spu_cmpabseq(vec_float4 a_, vec_float4 b_) {
  return softcell_sdk::make<vec_uint4>(softcell_sdk::magnitude_order(a_) ==
                                       softcell_sdk::magnitude_order(b_));
}
SC_SDK_INLINE vec_uint4 spu_cmpabsgt(vec_float4 a_, vec_float4 b_) {
  return softcell_sdk::make<vec_uint4>(softcell_sdk::magnitude_order(a_) > softcell_sdk::magnitude_order(b_));
}
