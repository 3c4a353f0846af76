#pragma once
// Double precision: IEEE 754, rounding to nearest even, denormal operands read as zero, denormal results
// kept, and one NaN, 0x7FF8000000000000.  [SPU-ISA, floating point] documented
//
// The rounding mode of an SPU's doubles is set in FPSCR, which is not modelled (softcell_control.h): nearest
// even is what a program starts with. Since a kernel's own mode truncates, each operation here switches modes
// and back, which costs tens of cycles: as on a PS3's SPE, doubles are for the few places that need them.
// dfceq and its kin exist on the PowerXCell 8i only; on a PS3 a compiler expands spu_cmpeq and the like of
// doubles to many instructions. That they read denormals as zero is assumed; a test on such a machine would
// settle it.

#include "../shared/softcell_special_values.h"
#include "softcell_lanes.h"

namespace softcell_sdk {

/// MXCSR for doubles: all exceptions masked, nearest even, denormal operands zero, denormal results kept.
constexpr unsigned int kDoubleArithmetic = 0x1FC0;

/// Quiet NaNs of any payload become the one that the SPU makes.
SC_SDK_INLINE vec_double2 one_nan(__m128d value) {
  const __m128i magnitude = _mm_and_si128((__m128i)value, _mm_set1_epi64x(INT64_MAX));
  const __m128i nan = _mm_cmpgt_epi64(magnitude, _mm_set1_epi64x(0x7FF0000000000000));
  return make<vec_double2>(_mm_blendv_epi8((__m128i)value, _mm_set1_epi64x(0x7FF8000000000000), nan));
}

/// All but a NaN change sign.
SC_SDK_INLINE vec_double2 negate_unless_nan(vec_double2 v_) {
  const __m128i nan = _mm_cmpeq_epi64(bits(v_), _mm_set1_epi64x(0x7FF8000000000000));
  return make<vec_double2>(_mm_xor_si128(bits(v_), _mm_andnot_si128(nan, _mm_set1_epi64x(INT64_MIN))));
}

// The instruction stands between the two switches of mode in one block, so that no compiler can move it out
// or compute it beforehand in another mode.
#define SC_SDK_IN_DOUBLE_ARITHMETIC(instruction, result, ...)                         \
  unsigned int saved;                                                                 \
  asm("vstmxcsr %[saved]\n\tvldmxcsr %[mode]\n\t" instruction "\n\tvldmxcsr %[saved]" \
      : [r_] result, [saved] "=&m"(saved)                                             \
      : [mode] "m"(kDoubleArithmetic), __VA_ARGS__)

#define SC_SDK_DOUBLE2(name, instruction)                                       \
  SC_SDK_INLINE vec_double2 name(vec_double2 a_, vec_double2 b_) {              \
    __m128d r_;                                                                 \
    SC_SDK_IN_DOUBLE_ARITHMETIC(instruction " %[b_], %[a_], %[r_]",             \
                                "=&x"(r_), [a_] "x"(a_.raw), [b_] "x"(b_.raw)); \
    return one_nan(r_);                                                         \
  }
SC_SDK_DOUBLE2(add, "vaddpd")
SC_SDK_DOUBLE2(subtract, "vsubpd")
SC_SDK_DOUBLE2(multiply, "vmulpd")
#undef SC_SDK_DOUBLE2

#define SC_SDK_DOUBLE3(name, instruction)                                          \
  SC_SDK_INLINE vec_double2 name(vec_double2 a_, vec_double2 b_, vec_double2 c_) { \
    __m128d r_ = a_.raw;                                                           \
    SC_SDK_IN_DOUBLE_ARITHMETIC(instruction " %[c_], %[b_], %[r_]",                \
                                "+&x"(r_), [b_] "x"(b_.raw), [c_] "x"(c_.raw));    \
    return one_nan(r_);                                                            \
  }
SC_SDK_DOUBLE3(multiply_add, "vfmadd213pd")
SC_SDK_DOUBLE3(multiply_subtract, "vfmsub213pd")
#undef SC_SDK_DOUBLE3

SC_SDK_INLINE __m128 to_single(vec_double2 a_) {
  __m128 r_;
  SC_SDK_IN_DOUBLE_ARITHMETIC("vcvtpd2ps %[a_], %[r_]", "=&x"(r_), [a_] "x"(a_.raw));
  return r_;
}
#undef SC_SDK_IN_DOUBLE_ARITHMETIC

/// Denormals become zeros of their sign.
SC_SDK_INLINE __m128d flushed(vec_double2 v_) {
  const __m128i exponent = _mm_and_si128(bits(v_), _mm_set1_epi64x(0x7FF0000000000000));
  const __m128i zero = _mm_cmpeq_epi64(exponent, _mm_setzero_si128());
  return (__m128d)_mm_andnot_si128(_mm_and_si128(zero, _mm_set1_epi64x(INT64_MAX)), bits(v_));
}
SC_SDK_INLINE __m128d flushed_magnitude(vec_double2 v_) {
  return (__m128d)_mm_and_si128((__m128i)flushed(v_), _mm_set1_epi64x(INT64_MAX));
}

}  // namespace softcell_sdk

SC_SDK_INLINE vec_double2 spu_add(vec_double2 a_, vec_double2 b_) { return softcell_sdk::add(a_, b_); }
SC_SDK_INLINE vec_double2 spu_sub(vec_double2 a_, vec_double2 b_) { return softcell_sdk::subtract(a_, b_); }
SC_SDK_INLINE vec_double2 spu_mul(vec_double2 a_, vec_double2 b_) { return softcell_sdk::multiply(a_, b_); }
/// a * b + c, rounded once.
SC_SDK_INLINE vec_double2 spu_madd(vec_double2 a_, vec_double2 b_, vec_double2 c_) {
  return softcell_sdk::multiply_add(a_, b_, c_);
}
/// a * b - c, rounded once.
SC_SDK_INLINE vec_double2 spu_msub(vec_double2 a_, vec_double2 b_, vec_double2 c_) {
  return softcell_sdk::multiply_subtract(a_, b_, c_);
}
/// -(a * b - c): the sign changes after rounding, so that a difference of zero is -0.
SC_SDK_INLINE vec_double2 spu_nmsub(vec_double2 a_, vec_double2 b_, vec_double2 c_) {
  return softcell_sdk::negate_unless_nan(softcell_sdk::multiply_subtract(a_, b_, c_));
}
/// -(a * b + c): the sign changes after rounding.
SC_SDK_INLINE vec_double2 spu_nmadd(vec_double2 a_, vec_double2 b_, vec_double2 c_) {
  return softcell_sdk::negate_unless_nan(softcell_sdk::multiply_add(a_, b_, c_));
}

// ---- compares: NaN is neither equal to nor greater than anything

SC_SDK_INLINE vec_ullong2 spu_cmpeq(vec_double2 a_, vec_double2 b_) {
  return softcell_sdk::make<vec_ullong2>(_mm_cmpeq_pd(softcell_sdk::flushed(a_), softcell_sdk::flushed(b_)));
}
SC_SDK_INLINE vec_ullong2 spu_cmpgt(vec_double2 a_, vec_double2 b_) {
  return softcell_sdk::make<vec_ullong2>(_mm_cmpgt_pd(softcell_sdk::flushed(a_), softcell_sdk::flushed(b_)));
}
SC_SDK_INLINE vec_ullong2 spu_cmpabseq(vec_double2 a_, vec_double2 b_) {
  using namespace softcell_sdk;
  return make<vec_ullong2>(_mm_cmpeq_pd(flushed_magnitude(a_), flushed_magnitude(b_)));
}
SC_SDK_INLINE vec_ullong2 spu_cmpabsgt(vec_double2 a_, vec_double2 b_) {
  using namespace softcell_sdk;
  return make<vec_ullong2>(_mm_cmpgt_pd(flushed_magnitude(a_), flushed_magnitude(b_)));
}

// ---- special values

namespace softcell_sdk {

/// The kinds as a number, for C.
SC_SDK_INLINE vec_ullong2 special_values(vec_double2 a_, int kinds) {
  const Raw<long long> magnitude = (Raw<long long>)a_.raw & INT64_MAX;
  const Raw<long long> negative = (Raw<long long>)a_.raw < 0;
  const Raw<long long> infinity = magnitude == 0x7FF0000000000000, nan = magnitude > 0x7FF0000000000000;
  const Raw<long long> zero = magnitude == 0, denormal = ~zero & (magnitude < 0x0010000000000000);
  Raw<long long> found{};
  if ((kinds & SPU_SV_NEG_DENORM) != 0) found |= denormal & negative;
  if ((kinds & SPU_SV_POS_DENORM) != 0) found |= denormal & ~negative;
  if ((kinds & SPU_SV_NEG_ZERO) != 0) found |= zero & negative;
  if ((kinds & SPU_SV_POS_ZERO) != 0) found |= zero & ~negative;
  if ((kinds & SPU_SV_NEG_INFINITY) != 0) found |= infinity & negative;
  if ((kinds & SPU_SV_POS_INFINITY) != 0) found |= infinity & ~negative;
  if ((kinds & SPU_SV_NAN) != 0) found |= nan;
  return make<vec_ullong2>(found);
}
template <int Kinds>
SC_SDK_INLINE vec_ullong2 test_special_value(vec_double2 a_) {
  static_assert(Kinds >= 0 && Kinds <= 0x7F, "spu_testsv takes a sum of SPU_SV_ constants, 0 to 127");
  return special_values(a_, Kinds);
}

}  // namespace softcell_sdk

/// All ones where the double is one of the kinds, a constant sum of SPU_SV_ values.
#define spu_testsv(ra, kinds) (softcell_sdk::test_special_value<(kinds)>(ra))
