#pragma once
// What programs commonly use of the SIMD math library: functions of four floats at once. [SDK for Multicore Acceleration, SIMD math
// library] documented
//
// Those of one instruction or a few are as the SPU computes them, with an error of 1 or 2 units in the last place; the others are math.h's,
// lane by lane.

#include <math.h>
#include <spu_intrinsics.h>

#define SC_SIMD_INLINE static inline __attribute__((unused))

SC_SIMD_INLINE vec_float4 fabsf4(vec_float4 v) {
  return (vec_float4)spu_and((vec_uint4)v, spu_splats(0x7FFFFFFFu));
}
SC_SIMD_INLINE vec_float4 negatef4(vec_float4 v) {
  return (vec_float4)spu_xor((vec_uint4)v, spu_splats(0x80000000u));
}
SC_SIMD_INLINE vec_float4 copysignf4(vec_float4 v, vec_float4 sign) {
  return spu_sel(v, sign, spu_splats(0x80000000u));
}
SC_SIMD_INLINE vec_float4 fminf4(vec_float4 a, vec_float4 b) { return spu_sel(a, b, spu_cmpgt(a, b)); }
SC_SIMD_INLINE vec_float4 fmaxf4(vec_float4 a, vec_float4 b) { return spu_sel(b, a, spu_cmpgt(a, b)); }
SC_SIMD_INLINE vec_int4 absi4(vec_int4 v) {
  return spu_sel(v, spu_sub(spu_splats(0), v), spu_cmpgt(spu_splats(0), v));
}

/// 1 / v and 1 / sqrt(v): the estimate, refined once.
SC_SIMD_INLINE vec_float4 recipf4(vec_float4 v) {
  const vec_float4 e = spu_re(v);
  return spu_madd(spu_nmsub(v, e, spu_splats(1.0f)), e, e);
}
SC_SIMD_INLINE vec_float4 rsqrtf4(vec_float4 v) {
  const vec_float4 e = spu_rsqrte(v), half = spu_mul(v, spu_splats(0.5f));
  return spu_madd(spu_nmsub(spu_mul(half, e), e, spu_splats(0.5f)), e, e);
}
SC_SIMD_INLINE vec_float4 divf4(vec_float4 a, vec_float4 b) {
  const vec_float4 quotient = spu_mul(a, recipf4(b));
  return spu_madd(spu_nmsub(quotient, b, a), recipf4(b), quotient);
}

#define SC_SIMD_BY_LANES_1(name)                                                                    \
  SC_SIMD_INLINE vec_float4 name##4(vec_float4 v) {                                                 \
    vec_float4 result = spu_splats(name(spu_extract(v, 0)));                                        \
    int lane;                                                                                       \
    for (lane = 1; lane < 4; ++lane) result = spu_insert(name(spu_extract(v, lane)), result, lane); \
    return result;                                                                                  \
  }
#define SC_SIMD_BY_LANES_2(name)                                                           \
  SC_SIMD_INLINE vec_float4 name##4(vec_float4 a, vec_float4 b) {                          \
    vec_float4 result = spu_splats(name(spu_extract(a, 0), spu_extract(b, 0)));            \
    int lane;                                                                              \
    for (lane = 1; lane < 4; ++lane)                                                       \
      result = spu_insert(name(spu_extract(a, lane), spu_extract(b, lane)), result, lane); \
    return result;                                                                         \
  }
SC_SIMD_BY_LANES_1(sqrtf)
SC_SIMD_BY_LANES_1(cbrtf)
SC_SIMD_BY_LANES_1(expf)
SC_SIMD_BY_LANES_1(exp2f)
SC_SIMD_BY_LANES_1(logf)
SC_SIMD_BY_LANES_1(log2f)
SC_SIMD_BY_LANES_1(log10f)
SC_SIMD_BY_LANES_1(sinf)
SC_SIMD_BY_LANES_1(cosf)
SC_SIMD_BY_LANES_1(tanf)
SC_SIMD_BY_LANES_1(asinf)
SC_SIMD_BY_LANES_1(acosf)
SC_SIMD_BY_LANES_1(atanf)
SC_SIMD_BY_LANES_1(floorf)
SC_SIMD_BY_LANES_1(ceilf)
SC_SIMD_BY_LANES_1(truncf)
SC_SIMD_BY_LANES_1(roundf)
SC_SIMD_BY_LANES_2(powf)
SC_SIMD_BY_LANES_2(atan2f)
SC_SIMD_BY_LANES_2(hypotf)
SC_SIMD_BY_LANES_2(fmodf)
#undef SC_SIMD_BY_LANES_1
#undef SC_SIMD_BY_LANES_2
