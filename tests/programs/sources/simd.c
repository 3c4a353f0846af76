/* simdmath.h: each lane has what math.h gives for it. */
#include <simdmath.h>
#include <simdmath/divf4.h>
#include <simdmath/sinf4.h>
#include <stdlib.h>

#include "check.h"

#define LANE(v, i) spu_extract(v, i)
static const vec_float4 a = {0.25f, 0.5f, 0.75f, 0.125f}, b = {1.5f, -2.0f, 3.25f, 1.0f};

#define OF_ONE(name)                                                     \
  do {                                                                   \
    int lane;                                                            \
    const vec_float4 v = _##name##4(a);                                  \
    for (lane = 0; lane < 4; ++lane) CHECK(LANE(v, lane) == name(LANE(a, lane))); \
  } while (0)
#define OF_TWO(name)                                                     \
  do {                                                                   \
    int lane;                                                            \
    const vec_float4 v = name##4(a, b);                                  \
    for (lane = 0; lane < 4; ++lane) CHECK(LANE(v, lane) == name(LANE(a, lane), LANE(b, lane))); \
  } while (0)
#define OF_DOUBLES(name)                                                 \
  do {                                                                   \
    const vec_double2 v = name##d2(x);                                   \
    CHECK(same(LANE(v, 0), name(LANE(x, 0))) && same(LANE(v, 1), name(LANE(x, 1)))); \
  } while (0)

static int same(double v, double w) { return v == w || (v != v && w != w); }

static int near(vec_float4 v, vec_float4 w, float ulps) {
  int lane;
  for (lane = 0; lane < 4; ++lane)
    if (fabsf(LANE(v, lane) - LANE(w, lane)) > ulps * 0x1p-23f * fabsf(LANE(w, lane))) return 0;
  return 1;
}

static void parts(void) {
  const vec_float4 v = {12.75f, -0.375f, 0.0f, 1e30f};
  const vec_int4 steps = {1, -1, 0, 3};
  vec_int4 exponents = spu_splats(0);
  vec_float4 wholes = v, fractions = frexpf4(v, &exponents), rests = modff4(v, &wholes);
  int lane, exponent;
  float whole;
  for (lane = 0; lane < 4; ++lane) {
    CHECK(LANE(fractions, lane) == frexpf(LANE(v, lane), &exponent) && LANE(exponents, lane) == exponent);
    CHECK(LANE(rests, lane) == modff(LANE(v, lane), &whole) && LANE(wholes, lane) == whole);
    CHECK(LANE(scalbnf4(v, steps), lane) == LANE(ldexpf4(v, steps), lane));
  }
}

static void whole_numbers(void) {
  const vec_float4 v = {2.5f, -3.5f, -0.0f, 1e-40f}, large = {1e12f, -1e12f, 0.5f, -0.5f};
  const vec_int4 n = {17, -17, 17, -5}, d = {5, 5, -5, 0};
  const vec_uint4 un = {4000000000u, 17u, 3u, 9u}, ud = {7u, 5u, 4u, 0u};
  const llroundf4_t rounded = llroundf4(large);
  const divi4_t signed_ones = divi4(n, d);
  const divu4_t unsigned_ones = divu4(un, ud);
  CHECK(LANE(iroundf4(v), 0) == 3 && LANE(iroundf4(v), 1) == -4 && LANE(irintf4(v), 1) == (int)lrintf(-3.5f) && LANE(irintf4(v), 2) == 0);
  CHECK(LANE(ilogbf4(large), 0) == 39 && LANE(ilogbf4(large), 3) == -1);
  CHECK(LANE(rounded.vll[0], 0) == 999999995904ll && LANE(rounded.vll[0], 1) == -999999995904ll && LANE(rounded.vll[1], 1) == llroundf(-0.5f));
  CHECK(LANE(signbitf4(v), 0) == 0 && LANE(signbitf4(v), 1) == 0xFFFFFFFFu && LANE(signbitf4(v), 2) == 0xFFFFFFFFu);
  CHECK(LANE(is0denormf4(v), 0) == 0 && LANE(is0denormf4(v), 2) == 0xFFFFFFFFu && LANE(is0denormf4(v), 3) == 0xFFFFFFFFu);
  CHECK(LANE(isnanf4(v), 0) == 0 && LANE(isinff4(v), 0) == 0);
  CHECK(LANE(signed_ones.quot, 0) == 3 && LANE(signed_ones.rem, 0) == 2 && LANE(signed_ones.quot, 1) == -3 && LANE(signed_ones.rem, 1) == -2);
  CHECK(LANE(signed_ones.quot, 2) == -3 && LANE(signed_ones.rem, 2) == 2 && LANE(signed_ones.quot, 3) == 0 && LANE(signed_ones.rem, 3) == -5);
  CHECK(LANE(unsigned_ones.quot, 0) == 571428571u && LANE(unsigned_ones.rem, 0) == 3u && LANE(unsigned_ones.rem, 2) == 3u);
  CHECK(LANE(unsigned_ones.quot, 3) == 0u && LANE(unsigned_ones.rem, 3) == 9u);
}

static void comparisons(void) {
  const vec_float4 v = {1.0f, -2.0f, 0.0f, 3.0f}, w = {1.0f, 2.0f, -1.0f, 4.0f}, kinds = {1e-40f, 0.0f, 1.0f, -2.0f};
  const vec_double2 x = {1.5, -2.0}, y = {1.5, 3.0}, odd = {NAN, -HUGE_VAL}, small = {0.0, 1e-310};
  const vec_uint4 all = spu_splats(0xFFFFFFFFu);
  const vec_ullong2 both = spu_splats(0xFFFFFFFFFFFFFFFFull);
  CHECK(LANE(isequalf4(v, w), 0) == 0xFFFFFFFFu && LANE(isequalf4(v, w), 1) == 0 && LANE(islessgreaterf4(v, w), 1) == 0xFFFFFFFFu);
  CHECK(LANE(isgreaterf4(v, w), 2) == 0xFFFFFFFFu && LANE(isgreaterf4(v, w), 0) == 0 && LANE(isgreaterequalf4(v, w), 0) == 0xFFFFFFFFu);
  CHECK(LANE(islessf4(v, w), 1) == 0xFFFFFFFFu && LANE(islessequalf4(v, w), 0) == 0xFFFFFFFFu && LANE(islessequalf4(v, w), 2) == 0);
  CHECK(LANE(spu_gather(spu_cmpeq(isfinitef4(v), all)), 0) == 15 && LANE(spu_gather(isunorderedf4(v, w)), 0) == 0);
  CHECK(LANE(isnormalf4(kinds), 0) == 0 && LANE(isnormalf4(kinds), 1) == 0 && LANE(isnormalf4(kinds), 2) == 0xFFFFFFFFu);
  CHECK(LANE(fpclassifyf4(kinds), 0) == FP_SUBNORMAL && LANE(fpclassifyf4(kinds), 1) == FP_ZERO && LANE(fpclassifyf4(kinds), 3) == FP_NORMAL);
  CHECK(LANE(isequald2(x, y), 0) == LANE(both, 0) && LANE(isequald2(x, y), 1) == 0 && LANE(islessgreaterd2(x, y), 1) == LANE(both, 1));
  CHECK(LANE(islessd2(x, y), 1) == LANE(both, 1) && LANE(islessequald2(x, y), 0) == LANE(both, 0) && LANE(isgreaterd2(y, x), 1) == LANE(both, 1));
  CHECK(LANE(isgreaterequald2(x, y), 0) == LANE(both, 0) && LANE(isgreaterequald2(x, y), 1) == 0 && LANE(islessgreaterd2(odd, x), 0) == 0);
  CHECK(LANE(isunorderedd2(odd, x), 0) == LANE(both, 0) && LANE(isunorderedd2(x, y), 1) == 0 && LANE(isnand2(odd), 0) == LANE(both, 0));
  CHECK(LANE(isinfd2(odd), 1) == LANE(both, 1) && LANE(isinfd2(odd), 0) == 0 && LANE(isfinited2(x), 0) == LANE(both, 0) && LANE(isfinited2(odd), 0) == 0);
  CHECK(LANE(isnormald2(x), 1) == LANE(both, 1) && LANE(isnormald2(small), 0) == 0 && LANE(is0denormd2(small), 0) == LANE(both, 0));
  CHECK(LANE(signbitd2(x), 1) == LANE(both, 1) && LANE(signbitd2(x), 0) == 0 && LANE(is0denormd2(x), 0) == 0);
  CHECK(LANE(fpclassifyd2(odd), 0) == FP_NAN && LANE(fpclassifyd2(odd), 1) == FP_INFINITE && LANE(fpclassifyd2(x), 0) == FP_NORMAL);
}

static void wide_numbers(void) {
  const vec_llong2 n = {-7000000000000ll, 17}, d = {1000000000000ll, -5};
  const vec_ullong2 un = {18000000000000000000ull, 17}, ud = {7, 0};
  const vec_double2 x = {12.75, -0.375}, y = {5.0, 0.25}, halves = {2.5, -3.5};
  const lldivi2_t quotients = lldivi2(n, d);
  const lldivu2_t unsigned_quotients = lldivu2(un, ud);
  const llroundf4_t rounded = llrintf4(a);
  vec_llong2 exponents = n;
  vec_double2 wholes = x, sine, cosine, parts_of_x = frexpd2(x, &exponents), rests = modfd2(x, &wholes);
  vec_int4 quotient = spu_splats(0);
  const vec_float4 remainders = remquof4(b, a, &quotient);
  CHECK(LANE(quotients.quot, 0) == -7 && LANE(quotients.rem, 0) == 0 && LANE(quotients.quot, 1) == -3 && LANE(quotients.rem, 1) == 2);
  CHECK(LANE(unsigned_quotients.quot, 0) == 18000000000000000000ull / 7 && LANE(unsigned_quotients.rem, 1) == 17);
  CHECK(LANE(llabsi2(n), 0) == 7000000000000ll && LANE(negatell2(n), 1) == -17 && LANE(negatei4(spu_splats(5)), 2) == -5);
  CHECK(LANE(parts_of_x, 0) == 0.796875 && LANE(exponents, 0) == 4 && LANE(parts_of_x, 1) == -0.75 && LANE(exponents, 1) == -1);
  CHECK(LANE(ldexpd2(parts_of_x, exponents), 0) == 12.75 && LANE(scalbllnd2(parts_of_x, exponents), 1) == -0.375);
  CHECK(LANE(ldexpd2(x, n), 0) == 0 && LANE(wholes, 0) == 12 && LANE(rests, 0) == 0.75 && LANE(rests, 1) == -0.375);
  CHECK(LANE(llrintd2(halves), 0) == 2 && LANE(llroundd2(halves), 0) == 3 && LANE(llroundd2(halves), 1) == -4 && LANE(ilogbd2(x), 1) == -2);
  CHECK(LANE(atan2d2(x, y), 0) == atan2(12.75, 5) && LANE(hypotd2(x, y), 1) == hypot(-0.375, 0.25) && LANE(fdimd2(x, y), 0) == 7.75);
  CHECK(LANE(nextafterd2(x, y), 0) == nextafter(12.75, 5) && LANE(remainderd2(x, y), 0) == -2.25);
  CHECK(LANE(remquod2(x, y, &exponents), 0) == -2.25 && LANE(exponents, 0) == 3 && LANE(exponents, 1) == -2);
  CHECK(LANE(remainders, 0) == remainderf(1.5f, 0.25f) && LANE(quotient, 0) == 6 && LANE(quotient, 1) == -4);
  sincosd2(x, &sine, &cosine);
  CHECK(LANE(sine, 0) == sin(12.75) && LANE(cosine, 1) == cos(-0.375) && LANE(rounded.vll[1], 0) == 1 && LANE(rounded.vll[0], 1) == (long long)rintf(0.5f));
  CHECK(LANE(divf4_fast(b, a), 0) == LANE(divf4(b, a), 0) && LANE(recipf4_fast(a), 1) == LANE(recipf4(a), 1) && LANE(sqrtf4_fast(a), 0) == 0.5f);
  CHECK(LANE(fmodf4_fast(b, a), 1) == 0 && LANE(floorf4_fast(b), 2) == 3 && LANE(ceilf4_fast(b), 2) == 4 && SM_PI == M_PI);
}

int main(void) {
  const vec_double2 x = {2.25, -0.5}, y = {0.5, 2.0};
  const vec_float4 third = {1 / 0.25f, 1 / 0.5f, 1 / 0.75f, 1 / 0.125f};
  const vec_int4 steps = {1, -1, 0, 3};
  vec_float4 sine, cosine;
  OF_ONE(sqrtf);
  OF_ONE(cbrtf);
  OF_ONE(expf);
  OF_ONE(exp2f);
  OF_ONE(expm1f);
  OF_ONE(logf);
  OF_ONE(log2f);
  OF_ONE(log10f);
  OF_ONE(log1pf);
  OF_ONE(logbf);
  OF_ONE(sinf);
  OF_ONE(cosf);
  OF_ONE(tanf);
  OF_ONE(asinf);
  OF_ONE(acosf);
  OF_ONE(atanf);
  OF_ONE(sinhf);
  OF_ONE(coshf);
  OF_ONE(tanhf);
  OF_ONE(asinhf);
  OF_ONE(atanhf);
  OF_ONE(floorf);
  OF_ONE(ceilf);
  OF_ONE(truncf);
  OF_ONE(roundf);
  OF_ONE(rintf);
  OF_ONE(nearbyintf);
  OF_ONE(erff);
  OF_ONE(erfcf);
  OF_ONE(lgammaf);
  OF_ONE(tgammaf);
  OF_TWO(powf);
  OF_TWO(atan2f);
  OF_TWO(hypotf);
  OF_TWO(fmodf);
  OF_TWO(remainderf);
  OF_TWO(fdimf);
  OF_DOUBLES(sqrt);
  OF_DOUBLES(exp);
  OF_DOUBLES(log);
  OF_DOUBLES(sin);
  OF_DOUBLES(cos);
  OF_DOUBLES(tan);
  OF_DOUBLES(floor);
  OF_DOUBLES(ceil);
  OF_DOUBLES(fabs);
  OF_DOUBLES(exp2);
  OF_DOUBLES(trunc);
  OF_DOUBLES(round);
  OF_DOUBLES(rint);
  OF_DOUBLES(nearbyint);
  OF_DOUBLES(cbrt);
  OF_DOUBLES(expm1);
  OF_DOUBLES(log2);
  OF_DOUBLES(log10);
  OF_DOUBLES(log1p);
  OF_DOUBLES(logb);
  OF_DOUBLES(asin);
  OF_DOUBLES(acos);
  OF_DOUBLES(atan);
  OF_DOUBLES(sinh);
  OF_DOUBLES(cosh);
  OF_DOUBLES(tanh);
  OF_DOUBLES(asinh);
  OF_DOUBLES(acosh);
  OF_DOUBLES(atanh);
  OF_DOUBLES(erf);
  OF_DOUBLES(erfc);
  OF_DOUBLES(lgamma);
  OF_DOUBLES(tgamma);
  OF_TWO(nextafterf);
  CHECK(LANE(acoshf4(third), 0) == acoshf(4.0f));
  CHECK(near(recipf4(a), third, 2) && near(divf4(b, a), spu_mul(b, third), 3) && near(rsqrtf4(a), sqrtf4(third), 3));
  CHECK(LANE(fminf4(a, b), 1) == -2.0f && LANE(fmaxf4(a, b), 1) == 0.5f && LANE(copysignf4(a, b), 1) == -0.5f);
  CHECK(LANE(fabsf4(b), 1) == 2.0f && LANE(negatef4(b), 1) == 2.0f && LANE(absi4(steps), 1) == 1);
  CHECK(LANE(fmaf4(a, b, a), 2) == 0.75f * 3.25f + 0.75f && LANE(ldexpf4(a, steps), 3) == 1.0f && LANE(ldexpf4(a, steps), 1) == 0.25f);
  sincosf4(a, &sine, &cosine);
  CHECK(LANE(sine, 2) == sinf(0.75f) && LANE(cosine, 3) == cosf(0.125f));
  CHECK(LANE(powd2(fabsd2(x), y), 0) == pow(2.25, 0.5) && LANE(fmodd2(x, y), 1) == -0.5 && LANE(divd2(x, y), 0) == 4.5);
  parts();
  comparisons();
  wide_numbers();
  whole_numbers();
  CHECK(LANE(fmind2(x, y), 0) == 0.5 && LANE(fmaxd2(x, y), 1) == 2.0 && LANE(copysignd2(y, x), 1) == -2.0 && LANE(negated2(x), 1) == 0.5);
  CHECK(LANE(recipd2(y), 1) == 0.5 && LANE(rsqrtd2(x), 0) == 1 / 1.5 && LANE(fmad2(x, y, y), 0) == 2.25 * 0.5 + 0.5);
  exit(failures);
}
