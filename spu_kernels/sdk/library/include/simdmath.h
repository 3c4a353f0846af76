#pragma once
// What programs commonly use of the SIMD math library: functions of four floats or two doubles at once. [SDK for Multicore Acceleration,
// SIMD math library] documented
//
// Those of one instruction or a few are as the SPU computes them, with an error of 1 or 2 units in the last place; the others are math.h's,
// lane by lane.

#include <math.h>
#include <spu_intrinsics.h>

#define SC_SIMD_INLINE static __inline__ __attribute__((unused))

#define SM_E M_E
#define SM_LOG2E M_LOG2E
#define SM_LOG10E M_LOG10E
#define SM_LN2 M_LN2
#define SM_LN10 M_LN10
#define SM_PI M_PI
#define SM_PI_2 M_PI_2
#define SM_PI_4 M_PI_4
#define SM_1_PI M_1_PI
#define SM_2_PI M_2_PI
#define SM_2_SQRTPI M_2_SQRTPI
#define SM_SQRT2 M_SQRT2
#define SM_SQRT1_2 M_SQRT1_2

SC_SIMD_INLINE vec_float4 fabsf4(vec_float4 v_) {
  return (vec_float4)spu_and((vec_uint4)v_, spu_splats(0x7FFFFFFFu));
}
SC_SIMD_INLINE vec_float4 negatef4(vec_float4 v_) {
  return (vec_float4)spu_xor((vec_uint4)v_, spu_splats(0x80000000u));
}
SC_SIMD_INLINE vec_float4 copysignf4(vec_float4 v_, vec_float4 sign) {
  return spu_sel(v_, sign, spu_splats(0x80000000u));
}
SC_SIMD_INLINE vec_float4 fminf4(vec_float4 a_, vec_float4 b_) { return spu_sel(a_, b_, spu_cmpgt(a_, b_)); }
SC_SIMD_INLINE vec_float4 fmaxf4(vec_float4 a_, vec_float4 b_) { return spu_sel(b_, a_, spu_cmpgt(a_, b_)); }
SC_SIMD_INLINE vec_int4 absi4(vec_int4 v_) {
  return spu_sel(v_, spu_sub(spu_splats(0), v_), spu_cmpgt(spu_splats(0), v_));
}
SC_SIMD_INLINE vec_int4 negatei4(vec_int4 v_) { return spu_sub(spu_splats(0), v_); }

/// 1 / v and 1 / sqrt(v): the estimate, refined once.
SC_SIMD_INLINE vec_float4 recipf4(vec_float4 v_) {
  const vec_float4 e_ = spu_re(v_);
  return spu_madd(spu_nmsub(v_, e_, spu_splats(1.0f)), e_, e_);
}
SC_SIMD_INLINE vec_float4 rsqrtf4(vec_float4 v_) {
  const vec_float4 e_ = spu_rsqrte(v_), half = spu_mul(v_, spu_splats(0.5f));
  return spu_madd(spu_nmsub(spu_mul(half, e_), e_, spu_splats(0.5f)), e_, e_);
}
SC_SIMD_INLINE vec_float4 divf4(vec_float4 a_, vec_float4 b_) {
  const vec_float4 quotient = spu_mul(a_, recipf4(b_));
  return spu_madd(spu_nmsub(quotient, b_, a_), recipf4(b_), quotient);
}

#define SC_SIMD_BY_LANES_1(name)                                                                     \
  SC_SIMD_INLINE vec_float4 name##4(vec_float4 v_) {                                                 \
    vec_float4 result = spu_splats(name(spu_extract(v_, 0)));                                        \
    int lane;                                                                                        \
    for (lane = 1; lane < 4; ++lane) result = spu_insert(name(spu_extract(v_, lane)), result, lane); \
    return result;                                                                                   \
  }
#define SC_SIMD_BY_LANES_2(name)                                                             \
  SC_SIMD_INLINE vec_float4 name##4(vec_float4 a_, vec_float4 b_) {                          \
    vec_float4 result = spu_splats(name(spu_extract(a_, 0), spu_extract(b_, 0)));            \
    int lane;                                                                                \
    for (lane = 1; lane < 4; ++lane)                                                         \
      result = spu_insert(name(spu_extract(a_, lane), spu_extract(b_, lane)), result, lane); \
    return result;                                                                           \
  }
SC_SIMD_BY_LANES_1(sqrtf)
SC_SIMD_BY_LANES_1(cbrtf)
SC_SIMD_BY_LANES_1(expf)
SC_SIMD_BY_LANES_1(exp2f)
SC_SIMD_BY_LANES_1(expm1f)
SC_SIMD_BY_LANES_1(logf)
SC_SIMD_BY_LANES_1(log2f)
SC_SIMD_BY_LANES_1(log10f)
SC_SIMD_BY_LANES_1(log1pf)
SC_SIMD_BY_LANES_1(logbf)
SC_SIMD_BY_LANES_1(sinf)
SC_SIMD_BY_LANES_1(cosf)
SC_SIMD_BY_LANES_1(tanf)
SC_SIMD_BY_LANES_1(asinf)
SC_SIMD_BY_LANES_1(acosf)
SC_SIMD_BY_LANES_1(atanf)
SC_SIMD_BY_LANES_1(sinhf)
SC_SIMD_BY_LANES_1(coshf)
SC_SIMD_BY_LANES_1(tanhf)
SC_SIMD_BY_LANES_1(asinhf)
SC_SIMD_BY_LANES_1(acoshf)
SC_SIMD_BY_LANES_1(atanhf)
SC_SIMD_BY_LANES_1(floorf)
SC_SIMD_BY_LANES_1(ceilf)
SC_SIMD_BY_LANES_1(truncf)
SC_SIMD_BY_LANES_1(roundf)
SC_SIMD_BY_LANES_1(rintf)
SC_SIMD_BY_LANES_1(nearbyintf)
SC_SIMD_BY_LANES_1(erff)
SC_SIMD_BY_LANES_1(erfcf)
SC_SIMD_BY_LANES_1(lgammaf)
SC_SIMD_BY_LANES_1(tgammaf)
SC_SIMD_BY_LANES_2(powf)
SC_SIMD_BY_LANES_2(atan2f)
SC_SIMD_BY_LANES_2(hypotf)
SC_SIMD_BY_LANES_2(fmodf)
SC_SIMD_BY_LANES_2(remainderf)
SC_SIMD_BY_LANES_2(fdimf)
SC_SIMD_BY_LANES_2(nextafterf)
#undef SC_SIMD_BY_LANES_1
#undef SC_SIMD_BY_LANES_2

SC_SIMD_INLINE vec_float4 fmaf4(vec_float4 a_, vec_float4 b_, vec_float4 c_) { return spu_madd(a_, b_, c_); }
SC_SIMD_INLINE vec_float4 ldexpf4(vec_float4 v_, vec_int4 exponents) {
  vec_float4 result = v_;
  int lane;
  for (lane = 0; lane < 4; ++lane)
    result = spu_insert(ldexpf(spu_extract(v_, lane), spu_extract(exponents, lane)), result, lane);
  return result;
}
SC_SIMD_INLINE vec_float4 scalbnf4(vec_float4 v_, vec_int4 exponents) { return ldexpf4(v_, exponents); }
SC_SIMD_INLINE vec_float4 frexpf4(vec_float4 v_, vec_int4* exponents) {
  vec_float4 result = v_;
  int lane, exponent;
  for (lane = 0; lane < 4; ++lane) {
    result = spu_insert(frexpf(spu_extract(v_, lane), &exponent), result, lane);
    *exponents = spu_insert(exponent, *exponents, lane);
  }
  return result;
}
SC_SIMD_INLINE vec_float4 modff4(vec_float4 v_, vec_float4* wholes) {
  vec_float4 result = v_;
  int lane;
  float whole;
  for (lane = 0; lane < 4; ++lane) {
    result = spu_insert(modff(spu_extract(v_, lane), &whole), result, lane);
    *wholes = spu_insert(whole, *wholes, lane);
  }
  return result;
}
SC_SIMD_INLINE vec_float4 remquof4(vec_float4 a_, vec_float4 b_, vec_int4* quotients) {
  vec_float4 result = a_;
  int lane, quotient;
  for (lane = 0; lane < 4; ++lane) {
    result = spu_insert(remquof(spu_extract(a_, lane), spu_extract(b_, lane), &quotient), result, lane);
    *quotients = spu_insert(quotient, *quotients, lane);
  }
  return result;
}

/* The SDK's faster variants, here the same functions. */
#define divf4_fast divf4
#define recipf4_fast recipf4
#define sqrtf4_fast sqrtf4
#define fmodf4_fast fmodf4
#define floorf4_fast floorf4
#define ceilf4_fast ceilf4

/* Of floats, a whole number each. */
#define SC_SIMD_WHOLE(name, function)                                          \
  SC_SIMD_INLINE vec_int4 name(vec_float4 v_) {                                \
    vec_int4 result = spu_splats((int)function(spu_extract(v_, 0)));           \
    int lane;                                                                  \
    for (lane = 1; lane < 4; ++lane)                                           \
      result = spu_insert((int)function(spu_extract(v_, lane)), result, lane); \
    return result;                                                             \
  }
SC_SIMD_WHOLE(ilogbf4, ilogbf)
SC_SIMD_WHOLE(irintf4, lrintf)
SC_SIMD_WHOLE(iroundf4, lroundf)
#undef SC_SIMD_WHOLE
typedef struct {
  vec_llong2 vll[2];
} llroundf4_t;
#define SC_SIMD_LONG(name)                                                                         \
  SC_SIMD_INLINE llroundf4_t name##4(vec_float4 v_) {                                              \
    llroundf4_t result;                                                                            \
    result.vll[0] = spu_insert(name(spu_extract(v_, 1)), spu_splats(name(spu_extract(v_, 0))), 1); \
    result.vll[1] = spu_insert(name(spu_extract(v_, 3)), spu_splats(name(spu_extract(v_, 2))), 1); \
    return result;                                                                                 \
  }
SC_SIMD_LONG(llroundf)
SC_SIMD_LONG(llrintf)
#undef SC_SIMD_LONG

/* Masks: all ones in the lanes for which it is true. Floats of an SPU are never NaN or infinite. */
SC_SIMD_INLINE vec_uint4 signbitf4(vec_float4 v_) { return spu_cmpgt(spu_splats(0), (vec_int4)v_); }
SC_SIMD_INLINE vec_uint4 is0denormf4(vec_float4 v_) {
  return spu_cmpeq(spu_and((vec_uint4)v_, spu_splats(0x7F800000u)), spu_splats(0u));
}
SC_SIMD_INLINE vec_uint4 isnanf4(vec_float4 v_) {
  (void)v_;
  return spu_splats(0u);
}
SC_SIMD_INLINE vec_uint4 isinff4(vec_float4 v_) {
  (void)v_;
  return spu_splats(0u);
}
SC_SIMD_INLINE vec_uint4 isfinitef4(vec_float4 v_) {
  (void)v_;
  return spu_splats(0xFFFFFFFFu);
}
SC_SIMD_INLINE vec_uint4 isnormalf4(vec_float4 v_) {
  const vec_uint4 zero = is0denormf4(v_);
  return spu_nor(zero, zero);
}
SC_SIMD_INLINE vec_uint4 isunorderedf4(vec_float4 a_, vec_float4 b_) {
  (void)a_;
  (void)b_;
  return spu_splats(0u);
}
SC_SIMD_INLINE vec_uint4 isequalf4(vec_float4 a_, vec_float4 b_) { return spu_cmpeq(a_, b_); }
SC_SIMD_INLINE vec_uint4 isgreaterf4(vec_float4 a_, vec_float4 b_) { return spu_cmpgt(a_, b_); }
SC_SIMD_INLINE vec_uint4 islessf4(vec_float4 a_, vec_float4 b_) { return spu_cmpgt(b_, a_); }
SC_SIMD_INLINE vec_uint4 islessgreaterf4(vec_float4 a_, vec_float4 b_) {
  const vec_uint4 equal = spu_cmpeq(a_, b_);
  return spu_nor(equal, equal);
}
SC_SIMD_INLINE vec_uint4 isgreaterequalf4(vec_float4 a_, vec_float4 b_) {
  const vec_uint4 less = spu_cmpgt(b_, a_);
  return spu_nor(less, less);
}
SC_SIMD_INLINE vec_uint4 islessequalf4(vec_float4 a_, vec_float4 b_) { return isgreaterequalf4(b_, a_); }
/* FP_ZERO, FP_SUBNORMAL or FP_NORMAL. */
SC_SIMD_INLINE vec_int4 fpclassifyf4(vec_float4 v_) {
  const vec_uint4 zero = spu_cmpeq(spu_and((vec_uint4)v_, spu_splats(0x7FFFFFFFu)), spu_splats(0u));
  return spu_sel(spu_sel(spu_splats(FP_NORMAL), spu_splats(FP_SUBNORMAL), is0denormf4(v_)),
                 spu_splats(FP_ZERO), zero);
}

/* Quotients and remainders; of a division by 0 the quotient is 0 and the remainder the number. */
typedef struct {
  vec_int4 quot, rem;
} divi4_t;
typedef struct {
  vec_uint4 quot, rem;
} divu4_t;
SC_SIMD_INLINE divu4_t divu4(vec_uint4 a_, vec_uint4 b_) {
  divu4_t result;
  int lane;
  result.quot = spu_splats(0u);
  result.rem = a_;
  for (lane = 0; lane < 4; ++lane) {
    const unsigned int n_ = spu_extract(a_, lane), divisor = spu_extract(b_, lane);
    if (divisor == 0) continue;
    result.quot = spu_insert(n_ / divisor, result.quot, lane);
    result.rem = spu_insert(n_ % divisor, result.rem, lane);
  }
  return result;
}
SC_SIMD_INLINE divi4_t divi4(vec_int4 a_, vec_int4 b_) {
  const divu4_t sizes = divu4((vec_uint4)absi4(a_), (vec_uint4)absi4(b_));
  const vec_int4 quotient = (vec_int4)sizes.quot, rest = (vec_int4)sizes.rem, zero = spu_splats(0);
  divi4_t result;
  result.quot = spu_sel(quotient, spu_sub(zero, quotient), spu_cmpgt(zero, spu_xor(a_, b_)));
  result.rem = spu_sel(rest, spu_sub(zero, rest), spu_cmpgt(zero, a_));
  return result;
}
typedef struct {
  vec_llong2 quot, rem;
} lldivi2_t;
typedef struct {
  vec_ullong2 quot, rem;
} lldivu2_t;
SC_SIMD_INLINE lldivu2_t lldivu2(vec_ullong2 a_, vec_ullong2 b_) {
  lldivu2_t result;
  int lane;
  result.quot = spu_splats(0ull);
  result.rem = a_;
  for (lane = 0; lane < 2; ++lane) {
    const unsigned long long n_ = spu_extract(a_, lane), divisor = spu_extract(b_, lane);
    if (divisor == 0) continue;
    result.quot = spu_insert(n_ / divisor, result.quot, lane);
    result.rem = spu_insert(n_ % divisor, result.rem, lane);
  }
  return result;
}
SC_SIMD_INLINE long long softcell_negated_if(int negative, unsigned long long size) {
  return (long long)(negative ? 0 - size : size);
}
SC_SIMD_INLINE vec_llong2 negatell2(vec_llong2 v_) {
  const long long first = softcell_negated_if(1, (unsigned long long)spu_extract(v_, 0));
  return spu_insert(softcell_negated_if(1, (unsigned long long)spu_extract(v_, 1)), spu_splats(first), 1);
}
SC_SIMD_INLINE vec_llong2 llabsi2(vec_llong2 v_) {
  const long long first = spu_extract(v_, 0), second = spu_extract(v_, 1);
  return spu_insert(softcell_negated_if(second < 0, (unsigned long long)second),
                    spu_splats(softcell_negated_if(first < 0, (unsigned long long)first)), 1);
}
SC_SIMD_INLINE lldivi2_t lldivi2(vec_llong2 a_, vec_llong2 b_) {
  const lldivu2_t sizes = lldivu2((vec_ullong2)llabsi2(a_), (vec_ullong2)llabsi2(b_));
  lldivi2_t result;
  int lane;
  result.quot = (vec_llong2)sizes.quot;
  result.rem = (vec_llong2)sizes.rem;
  for (lane = 0; lane < 2; ++lane) {
    const int negative = spu_extract(a_, lane) < 0, opposite = negative != (spu_extract(b_, lane) < 0);
    result.quot = spu_insert(softcell_negated_if(opposite, spu_extract(sizes.quot, lane)), result.quot, lane);
    result.rem = spu_insert(softcell_negated_if(negative, spu_extract(sizes.rem, lane)), result.rem, lane);
  }
  return result;
}
SC_SIMD_INLINE void sincosf4(vec_float4 v_, vec_float4* sine, vec_float4* cosine) {
  *sine = sinf4(v_);
  *cosine = cosf4(v_);
}

/* Two doubles at once. */
#define SC_SIMD_DOUBLES_1(name)                                                           \
  SC_SIMD_INLINE vec_double2 name##d2(vec_double2 v_) {                                   \
    return spu_insert(name(spu_extract(v_, 1)), spu_splats(name(spu_extract(v_, 0))), 1); \
  }
#define SC_SIMD_DOUBLES_2(name)                                                     \
  SC_SIMD_INLINE vec_double2 name##d2(vec_double2 a_, vec_double2 b_) {             \
    return spu_insert(name(spu_extract(a_, 1), spu_extract(b_, 1)),                 \
                      spu_splats(name(spu_extract(a_, 0), spu_extract(b_, 0))), 1); \
  }
SC_SIMD_DOUBLES_1(sqrt)
SC_SIMD_DOUBLES_1(exp)
SC_SIMD_DOUBLES_1(log)
SC_SIMD_DOUBLES_1(sin)
SC_SIMD_DOUBLES_1(cos)
SC_SIMD_DOUBLES_1(tan)
SC_SIMD_DOUBLES_1(floor)
SC_SIMD_DOUBLES_1(ceil)
SC_SIMD_DOUBLES_1(fabs)
SC_SIMD_DOUBLES_1(exp2)
SC_SIMD_DOUBLES_1(trunc)
SC_SIMD_DOUBLES_1(round)
SC_SIMD_DOUBLES_1(rint)
SC_SIMD_DOUBLES_1(nearbyint)
SC_SIMD_DOUBLES_1(cbrt)
SC_SIMD_DOUBLES_1(expm1)
SC_SIMD_DOUBLES_1(log2)
SC_SIMD_DOUBLES_1(log10)
SC_SIMD_DOUBLES_1(log1p)
SC_SIMD_DOUBLES_1(logb)
SC_SIMD_DOUBLES_1(asin)
SC_SIMD_DOUBLES_1(acos)
SC_SIMD_DOUBLES_1(atan)
SC_SIMD_DOUBLES_1(sinh)
SC_SIMD_DOUBLES_1(cosh)
SC_SIMD_DOUBLES_1(tanh)
SC_SIMD_DOUBLES_1(asinh)
SC_SIMD_DOUBLES_1(acosh)
SC_SIMD_DOUBLES_1(atanh)
SC_SIMD_DOUBLES_1(erf)
SC_SIMD_DOUBLES_1(erfc)
SC_SIMD_DOUBLES_1(lgamma)
SC_SIMD_DOUBLES_1(tgamma)
SC_SIMD_DOUBLES_2(pow)
SC_SIMD_DOUBLES_2(fmod)
SC_SIMD_DOUBLES_2(fmin)
SC_SIMD_DOUBLES_2(fmax)
SC_SIMD_DOUBLES_2(copysign)
SC_SIMD_DOUBLES_2(atan2)
SC_SIMD_DOUBLES_2(hypot)
SC_SIMD_DOUBLES_2(fdim)
SC_SIMD_DOUBLES_2(nextafter)
SC_SIMD_DOUBLES_2(remainder)
#undef SC_SIMD_DOUBLES_1
#undef SC_SIMD_DOUBLES_2
SC_SIMD_INLINE vec_double2 divd2(vec_double2 a_, vec_double2 b_) {
  return spu_insert(spu_extract(a_, 1) / spu_extract(b_, 1),
                    spu_splats(spu_extract(a_, 0) / spu_extract(b_, 0)), 1);
}
SC_SIMD_INLINE vec_double2 recipd2(vec_double2 v_) { return divd2(spu_splats(1.0), v_); }
SC_SIMD_INLINE vec_double2 rsqrtd2(vec_double2 v_) { return divd2(spu_splats(1.0), sqrtd2(v_)); }
SC_SIMD_INLINE vec_double2 negated2(vec_double2 v_) {
  return (vec_double2)spu_xor((vec_ullong2)v_, spu_splats(0x8000000000000000ull));
}
SC_SIMD_INLINE vec_double2 fmad2(vec_double2 a_, vec_double2 b_, vec_double2 c_) {
  return spu_madd(a_, b_, c_);
}
SC_SIMD_INLINE void sincosd2(vec_double2 v_, vec_double2* sine, vec_double2* cosine) {
  *sine = sind2(v_);
  *cosine = cosd2(v_);
}
SC_SIMD_INLINE vec_double2 modfd2(vec_double2 v_, vec_double2* wholes) {
  double first, second;
  const vec_double2 rest = spu_splats(modf(spu_extract(v_, 0), &first));
  const double other = modf(spu_extract(v_, 1), &second);
  *wholes = spu_insert(second, spu_splats(first), 1);
  return spu_insert(other, rest, 1);
}

/* Two doubles, and a whole number each. */
SC_SIMD_INLINE vec_llong2 softcell_llongs(long long first, long long second) {
  return spu_insert(second, spu_splats(first), 1);
}
SC_SIMD_INLINE vec_llong2 llrintd2(vec_double2 v_) {
  return softcell_llongs(llrint(spu_extract(v_, 0)), llrint(spu_extract(v_, 1)));
}
SC_SIMD_INLINE vec_llong2 llroundd2(vec_double2 v_) {
  return softcell_llongs(llround(spu_extract(v_, 0)), llround(spu_extract(v_, 1)));
}
SC_SIMD_INLINE vec_llong2 ilogbd2(vec_double2 v_) {
  return softcell_llongs(ilogb(spu_extract(v_, 0)), ilogb(spu_extract(v_, 1)));
}
SC_SIMD_INLINE vec_double2 frexpd2(vec_double2 v_, vec_llong2* exponents) {
  int first, second;
  const vec_double2 part = spu_splats(frexp(spu_extract(v_, 0), &first));
  const double other = frexp(spu_extract(v_, 1), &second);
  *exponents = softcell_llongs(first, second);
  return spu_insert(other, part, 1);
}
/* 2^9999 of any double is infinite, 2^-9999 of it 0. */
SC_SIMD_INLINE double softcell_scaled(double x_, long long exponent) {
  return ldexp(x_, exponent > 9999 ? 9999 : exponent < -9999 ? -9999 : (int)exponent);
}
SC_SIMD_INLINE vec_double2 ldexpd2(vec_double2 v_, vec_llong2 exponents) {
  return spu_insert(softcell_scaled(spu_extract(v_, 1), spu_extract(exponents, 1)),
                    spu_splats(softcell_scaled(spu_extract(v_, 0), spu_extract(exponents, 0))), 1);
}
SC_SIMD_INLINE vec_double2 scalbllnd2(vec_double2 v_, vec_llong2 exponents) { return ldexpd2(v_, exponents); }
SC_SIMD_INLINE vec_double2 remquod2(vec_double2 a_, vec_double2 b_, vec_llong2* quotients) {
  int first, second;
  const vec_double2 rest = spu_splats(remquo(spu_extract(a_, 0), spu_extract(b_, 0), &first));
  const double other = remquo(spu_extract(a_, 1), spu_extract(b_, 1), &second);
  *quotients = softcell_llongs(first, second);
  return spu_insert(other, rest, 1);
}
#define SC_SIMD_CLASS(x) __builtin_fpclassify(FP_NAN, FP_INFINITE, FP_NORMAL, FP_SUBNORMAL, FP_ZERO, x)
SC_SIMD_INLINE vec_llong2 fpclassifyd2(vec_double2 v_) {
  return softcell_llongs(SC_SIMD_CLASS(spu_extract(v_, 0)), SC_SIMD_CLASS(spu_extract(v_, 1)));
}

/* Masks of doubles: all ones in the lanes for which it is true. */
#define SC_SIMD_DOUBLE_IS(name, is)                                                   \
  SC_SIMD_INLINE vec_ullong2 name(vec_double2 v_) {                                   \
    const double first = spu_extract(v_, 0), second = spu_extract(v_, 1);             \
    return (vec_ullong2)softcell_llongs((is(first)) ? -1 : 0, (is(second)) ? -1 : 0); \
  }
#define SC_SIMD_IS_ZERO_OR_DENORMAL(x) (SC_SIMD_CLASS(x) == FP_ZERO || SC_SIMD_CLASS(x) == FP_SUBNORMAL)
SC_SIMD_DOUBLE_IS(isnand2, __builtin_isnan)
SC_SIMD_DOUBLE_IS(isinfd2, __builtin_isinf)
SC_SIMD_DOUBLE_IS(isfinited2, __builtin_isfinite)
SC_SIMD_DOUBLE_IS(isnormald2, __builtin_isnormal)
SC_SIMD_DOUBLE_IS(signbitd2, __builtin_signbit)
SC_SIMD_DOUBLE_IS(is0denormd2, SC_SIMD_IS_ZERO_OR_DENORMAL)
#undef SC_SIMD_DOUBLE_IS
#undef SC_SIMD_IS_ZERO_OR_DENORMAL
#undef SC_SIMD_CLASS
#define SC_SIMD_DOUBLES_COMPARE(name, compare)                                                     \
  SC_SIMD_INLINE vec_ullong2 name(vec_double2 a_, vec_double2 b_) {                                \
    return (vec_ullong2)softcell_llongs(compare(spu_extract(a_, 0), spu_extract(b_, 0)) ? -1 : 0,  \
                                        compare(spu_extract(a_, 1), spu_extract(b_, 1)) ? -1 : 0); \
  }
#define SC_SIMD_EQUAL(a, b) ((a) == (b))
SC_SIMD_DOUBLES_COMPARE(isequald2, SC_SIMD_EQUAL)
SC_SIMD_DOUBLES_COMPARE(isgreaterd2, __builtin_isgreater)
SC_SIMD_DOUBLES_COMPARE(isgreaterequald2, __builtin_isgreaterequal)
SC_SIMD_DOUBLES_COMPARE(islessd2, __builtin_isless)
SC_SIMD_DOUBLES_COMPARE(islessequald2, __builtin_islessequal)
SC_SIMD_DOUBLES_COMPARE(islessgreaterd2, __builtin_islessgreater)
SC_SIMD_DOUBLES_COMPARE(isunorderedd2, __builtin_isunordered)
#undef SC_SIMD_DOUBLES_COMPARE
#undef SC_SIMD_EQUAL

/* The inline functions of simdmath/NAME.h have an underscore in front. */
#define _fabsf4 fabsf4
#define _negatef4 negatef4
#define _copysignf4 copysignf4
#define _fminf4 fminf4
#define _fmaxf4 fmaxf4
#define _absi4 absi4
#define _recipf4 recipf4
#define _rsqrtf4 rsqrtf4
#define _divf4 divf4
#define _sqrtf4 sqrtf4
#define _cbrtf4 cbrtf4
#define _expf4 expf4
#define _exp2f4 exp2f4
#define _expm1f4 expm1f4
#define _logf4 logf4
#define _log2f4 log2f4
#define _log10f4 log10f4
#define _log1pf4 log1pf4
#define _logbf4 logbf4
#define _sinf4 sinf4
#define _cosf4 cosf4
#define _tanf4 tanf4
#define _asinf4 asinf4
#define _acosf4 acosf4
#define _atanf4 atanf4
#define _sinhf4 sinhf4
#define _coshf4 coshf4
#define _tanhf4 tanhf4
#define _asinhf4 asinhf4
#define _acoshf4 acoshf4
#define _atanhf4 atanhf4
#define _floorf4 floorf4
#define _ceilf4 ceilf4
#define _truncf4 truncf4
#define _roundf4 roundf4
#define _rintf4 rintf4
#define _nearbyintf4 nearbyintf4
#define _powf4 powf4
#define _atan2f4 atan2f4
#define _hypotf4 hypotf4
#define _fmodf4 fmodf4
#define _remainderf4 remainderf4
#define _fdimf4 fdimf4
#define _fmaf4 fmaf4
#define _ldexpf4 ldexpf4
#define _sincosf4 sincosf4
#define _sqrtd2 sqrtd2
#define _expd2 expd2
#define _logd2 logd2
#define _sind2 sind2
#define _cosd2 cosd2
#define _tand2 tand2
#define _floord2 floord2
#define _ceild2 ceild2
#define _fabsd2 fabsd2
#define _powd2 powd2
#define _fmodd2 fmodd2
#define _divd2 divd2
#define _nextafterf4 nextafterf4
#define _scalbnf4 scalbnf4
#define _frexpf4 frexpf4
#define _modff4 modff4
#define _ilogbf4 ilogbf4
#define _irintf4 irintf4
#define _iroundf4 iroundf4
#define _llroundf4 llroundf4
#define _signbitf4 signbitf4
#define _is0denormf4 is0denormf4
#define _isnanf4 isnanf4
#define _isinff4 isinff4
#define _divi4 divi4
#define _divu4 divu4
#define _exp2d2 exp2d2
#define _truncd2 truncd2
#define _roundd2 roundd2
#define _fmind2 fmind2
#define _fmaxd2 fmaxd2
#define _copysignd2 copysignd2
#define _recipd2 recipd2
#define _rsqrtd2 rsqrtd2
#define _negated2 negated2
#define _fmad2 fmad2
#define _negatei4 negatei4
#define _negatell2 negatell2
#define _llabsi2 llabsi2
#define _lldivi2 lldivi2
#define _lldivu2 lldivu2
#define _erff4 erff4
#define _erfcf4 erfcf4
#define _lgammaf4 lgammaf4
#define _tgammaf4 tgammaf4
#define _remquof4 remquof4
#define _fpclassifyf4 fpclassifyf4
#define _isequalf4 isequalf4
#define _isfinitef4 isfinitef4
#define _isgreaterf4 isgreaterf4
#define _isgreaterequalf4 isgreaterequalf4
#define _islessf4 islessf4
#define _islessequalf4 islessequalf4
#define _islessgreaterf4 islessgreaterf4
#define _isnormalf4 isnormalf4
#define _isunorderedf4 isunorderedf4
#define _llrintf4 llrintf4
#define _divf4_fast divf4_fast
#define _recipf4_fast recipf4_fast
#define _sqrtf4_fast sqrtf4_fast
#define _fmodf4_fast fmodf4_fast
#define _floorf4_fast floorf4_fast
#define _ceilf4_fast ceilf4_fast
#define _acosd2 acosd2
#define _acoshd2 acoshd2
#define _asind2 asind2
#define _asinhd2 asinhd2
#define _atand2 atand2
#define _atanhd2 atanhd2
#define _atan2d2 atan2d2
#define _cbrtd2 cbrtd2
#define _coshd2 coshd2
#define _sinhd2 sinhd2
#define _tanhd2 tanhd2
#define _erfd2 erfd2
#define _erfcd2 erfcd2
#define _expm1d2 expm1d2
#define _fdimd2 fdimd2
#define _fpclassifyd2 fpclassifyd2
#define _frexpd2 frexpd2
#define _hypotd2 hypotd2
#define _ilogbd2 ilogbd2
#define _is0denormd2 is0denormd2
#define _isequald2 isequald2
#define _isfinited2 isfinited2
#define _isgreaterd2 isgreaterd2
#define _isgreaterequald2 isgreaterequald2
#define _isinfd2 isinfd2
#define _islessd2 islessd2
#define _islessequald2 islessequald2
#define _islessgreaterd2 islessgreaterd2
#define _isnand2 isnand2
#define _isnormald2 isnormald2
#define _isunorderedd2 isunorderedd2
#define _ldexpd2 ldexpd2
#define _lgammad2 lgammad2
#define _tgammad2 tgammad2
#define _llrintd2 llrintd2
#define _llroundd2 llroundd2
#define _log10d2 log10d2
#define _log1pd2 log1pd2
#define _log2d2 log2d2
#define _logbd2 logbd2
#define _modfd2 modfd2
#define _nearbyintd2 nearbyintd2
#define _rintd2 rintd2
#define _nextafterd2 nextafterd2
#define _remainderd2 remainderd2
#define _remquod2 remquod2
#define _scalbllnd2 scalbllnd2
#define _signbitd2 signbitd2
#define _sincosd2 sincosd2
