#pragma once
// What programs commonly use of the SIMD math library: functions of four floats or two doubles at once. [SDK for Multicore Acceleration,
// SIMD math library] documented
//
// Those of one instruction or a few are as the SPU computes them, with an error of 1 or 2 units in the last place; the others are math.h's,
// lane by lane.

#include <math.h>
#include <spu_intrinsics.h>

#define SC_SIMD_INLINE static __inline__ __attribute__((unused))

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
SC_SIMD_INLINE llroundf4_t llroundf4(vec_float4 v_) {
  llroundf4_t result;
  result.vll[0] = spu_insert(llroundf(spu_extract(v_, 1)), spu_splats(llroundf(spu_extract(v_, 0))), 1);
  result.vll[1] = spu_insert(llroundf(spu_extract(v_, 3)), spu_splats(llroundf(spu_extract(v_, 2))), 1);
  return result;
}

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
SC_SIMD_DOUBLES_2(pow)
SC_SIMD_DOUBLES_2(fmod)
SC_SIMD_DOUBLES_2(fmin)
SC_SIMD_DOUBLES_2(fmax)
SC_SIMD_DOUBLES_2(copysign)
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
