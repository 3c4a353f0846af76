/* math.h: each function of doubles at a place where its value is known, and what takes or gives integers. */
#include <math.h>
#include <stdlib.h>

#include "check.h"

static int near(double a, double b) { return fabs(a - b) <= 1e-11 * (fabs(b) + 1e-3); }

static int is_none(double v) { return v != v; }

static void functions(void) {
  CHECK(sqrt(2) == 0x1.6A09E667F3BCDp0 && near(cbrt(-27), -3) && near(hypot(3, 4), 5) && near(pow(2, 0.5), sqrt(2)) && near(pow(-2, 3), -8));
  CHECK(near(exp(1), M_E) && near(exp2(-3), 0.125) && near(expm1(1e-9), 1.0000000005e-9) && near(log(M_E), 1) && near(log2(8), 3));
  CHECK(near(log10(1000), 3) && near(log1p(1e-9), 9.999999995e-10) && logb(10) == 3 && logb(0.3) == -2);
  CHECK(near(sin(1), 0.8414709848078965) && near(cos(1), 0.5403023058681398) && near(tan(1), 1.5574077246549022));
  CHECK(near(asin(0.5), M_PI / 6) && near(acos(0.5), M_PI / 3) && near(atan(1), M_PI_4) && near(atan2(-1, -1), -3 * M_PI_4));
  CHECK(near(sinh(1), 1.1752011936438014) && near(cosh(1), 1.5430806348152437) && near(tanh(0.5), 0.46211715726000973));
  CHECK(near(asinh(1), 0.881373587019543) && near(acosh(2), 1.3169578969248167) && near(atanh(0.5), 0.5493061443340549));
  CHECK(floor(-2.5) == -3 && ceil(-2.5) == -2 && trunc(-2.5) == -2 && round(-2.5) == -3 && rint(-2.5) == -2 && nearbyint(3.5) == 4);
  CHECK(fmod(-7, 3) == -1 && remainder(7, 4) == -1 && remainder(6, 4) == -2 && fmin(1, 2) == 1 && fmax(1, 2) == 2 && fdim(3, 1) == 2);
  CHECK(log(0) == -HUGE_VAL && log2(-0.0) == -HUGE_VAL && log10(0) == -HUGE_VAL && log1p(-1) == -HUGE_VAL && logb(0) == -HUGE_VAL);
  CHECK(atanh(1) == HUGE_VAL && atanh(-1) == -HUGE_VAL && log(HUGE_VAL) == HUGE_VAL && sqrt(0) == 0);
  CHECK(is_none(log(-1)) && is_none(log1p(-2)) && is_none(sqrt(-1)) && is_none(asin(2)) && is_none(acos(-2)) && is_none(acosh(0.5)) && is_none(atanh(2)));
  CHECK(is_none(fmod(1, 0)) && is_none(remainder(1, 0)) && is_none(log(NAN)));
  CHECK(near(sin(1e12), -0.6112387023768895) && near(cos(1e12), 0.7914463018528902) && near(sin(1e15), 0.8582727931702359));
  CHECK(near(sin(-123456789.12345679), -0.9998509309072103) && near(cos(123456789012345.67), 0.9995484960939164));
  CHECK(near(sin(1.0000000000001235e+20), 0.9644579013252669) && near(tan(1e15), 0.8582727931702359 / -0.5131937377869703));
  CHECK(copysign(1, -0.0) == -1 && fabs(-1.5) == 1.5 && fdim(1, 3) == 0);
}

static void parts(void) {
  int exponent;
  double whole;
  float whole_f;
  CHECK(frexp(-12, &exponent) == -0.75 && exponent == 4 && ldexp(-0.75, 4) == -12 && scalbn(1, 10) == 1024 && scalbln(1, -1) == 0.5);
  CHECK(frexpf(0.375f, &exponent) == 0.75f && exponent == -1 && ldexpf(1, -126) > 0 && ldexpf(1, -127) == 0 && ldexpf(1, 200) == HUGE_VALF);
  CHECK(scalbnf(3, 2) == 12 && scalblnf(3, -1) == 1.5f && ilogb(1000) == 9 && ilogbf(0.1f) == -4 && ilogb(0) == FP_ILOGB0);
  CHECK(modf(-3.25, &whole) == -0.25 && whole == -3 && modff(2.5f, &whole_f) == 0.5f && whole_f == 2);
  CHECK(lrint(2.5) == 2 && lround(2.5) == 3 && llrint(-1e12) == -1000000000000ll && llround(0.5) == 1);
  CHECK(lrintf(-2.5f) == -2 && lroundf(-2.5f) == -3 && llrintf(3.5f) == 4 && llroundf(1e10f) == 10000000000ll);
}

static void neighbours(void) {
  CHECK(nextafter(1, 2) == 0x1.0000000000001p0 && nextafter(1, 0) == 0x1.FFFFFFFFFFFFFp-1 && nextafter(3, 3) == 3);
  CHECK(nextafter(-1, -2) == -0x1.0000000000001p0 && nextafter(HUGE_VAL, 0) == 0x1.FFFFFFFFFFFFFp1023);
  CHECK(nextafterf(1, 2) == 0x1.000002p0f && nextafterf(-1, 2) == -0x1.FFFFFEp-1f && nextafterf(2, 2) == 2);
  CHECK(nextafterf(0, 1) == 0x1p-126f && nextafterf(0, -1) == -0x1p-126f && nextafterf(0x1p-126f, 0) == 0);
  CHECK(nextafterf(HUGE_VALF, 1) == 0x1.FFFFFCp127f && nextafterf(0x1.FFFFFCp127f, HUGE_VALF) == HUGE_VALF);
}

static volatile double one = 1, endless = HUGE_VAL, none = NAN;

static void floats(void) {
  volatile double x = 0x1.0000001p0;
  CHECK(fma(x, x, -1 - 0x1p-27) == 0x1p-56 && fma(3, 4, -12) == 0);
  CHECK(fmaf(3, 4, -12) == 0 && fmaf(0x1.000002p0f, 0x1.000002p0f, -1) == 0x1p-22f);
  CHECK(fminf(1, 2) == 1 && fmaxf(1, 2) == 2 && fdimf(5, 2) == 3 && copysignf(2, -1) == -2 && remainderf(5, 3) == -1);
  CHECK(near(atan2(0.0, -0.0), M_PI) && near(atan2(-0.0, -0.0), -M_PI) && fabs(atan2f(-0.0f, -0.0f) + M_PI) < 1e-6);
  CHECK(signbit(atan2(-0.0, 0.0)) != 0 && signbit(atan2(0.0, 0.0)) == 0);
  CHECK(fmodf(5.5f, -2) == 1.5f && powf(2, 10) == 1024 && atan2f(0, 0) == 0 && hypotf(6, 8) == 10);
  CHECK(sqrtf(-1) == 0 && logf(-1) == 0 && logf(0) == -HUGE_VALF && asinf(2) == 0 && expf(100) == HUGE_VALF && expf(-100) == 0);
  CHECK(isfinite(one) != 0 && isfinite(endless) == 0 && isnan(none) != 0 && isinf(-endless) != 0 && signbit(-one) != 0);
  CHECK(fpclassify(one - one) == FP_ZERO && isnormal(one) != 0);
}

/* What is a whole number, or another number of a few digits, is that number. (The arguments are no constants for the compiler.) */
static void exact_results(void) {
  volatile double x, y;
  for (int base = 2; base <= 60; ++base) {
    double expected = base;
    for (int n = 1; expected * base < 0x1p53; ++n, expected *= base) {
      x = base, y = n;
      CHECK(pow(x, y) == expected && pow(-x, y) == (n % 2 == 0 ? expected : -expected));
      y = 1.0 / n;
      if (n == 2 || n == 4) CHECK(pow(expected, y) == base);
    }
  }
  double expected = 1;
  for (int n = 0; n <= 22; ++n, expected *= 10) {
    x = expected;
    CHECK(log10(x) == n);
  }
  x = 2, y = 1023;
  CHECK(pow(x, y) == 0x1p1023 && pow(x, -1022) == 0x1p-1022 && pow(x, 1024) == HUGE_VAL && pow(x, -1080) == 0 && pow(x, -1) == 0.5);
  y = HUGE_VAL;
  CHECK(pow(x, y) == HUGE_VAL && pow(x, -y) == 0 && pow(y, x) == HUGE_VAL && pow(y, -x) == 0 && log10(y) == HUGE_VAL);
  y = NAN;
  CHECK(isnan(pow(x, y)) != 0 && isnan(pow(y, x)) != 0 && pow(y, 0) == 1);
  x = 3e200, y = 4e200;
  CHECK(near(hypot(x, y) * 1e-200, 5) && near(hypot(x * 1e-300, y) * 1e-200, 4) && hypot(HUGE_VAL, x) == HUGE_VAL && hypot(x * 1e108, x * 1e108) == HUGE_VAL);
  x = 3e-200, y = 4e-200;
  CHECK(near(hypot(x, y) * 1e200, 5) && near(hypot(x, 0) * 1e200, 3) && hypot(0, 0) == 0);
  for (int n = 1; n <= 1000; ++n) {
    x = 3.0 * n, y = -4.0 * n;
    CHECK(hypot(x, y) == 5.0 * n);
  }
}

static void error_and_gamma_functions(void) {
  volatile double x = 1;
  int i, quotient;
  CHECK(near(erf(0.5), 0.5204998778130465) && near(erf(-3), -0.9999779095030014) && erf(30) == 1 && erf(-0.0) == 0);
  CHECK(near(erfc(0.5), 0.4795001221869535) && near(erfc(-1), 1.842700792949715) && erfc(40) == 0);
  CHECK(near(erfc(5) * 1e12, 1.5374597944280349) && near(erfc(25) * 1e273, 0.8300172571196522));
  CHECK(near(tgamma(0.5), 1.772453850905516) && near(tgamma(-1.5), 2.3632718012073544) && near(tgamma(170) * 1e-304, 4.269068009004706));
  CHECK(tgamma(172) == HUGE_VAL && tgamma(0.0) == HUGE_VAL && tgamma(-0.0) == -HUGE_VAL && is_none(tgamma(-3)));
  CHECK(near(lgamma(0.1), 2.252712651734206) && near(lgamma(100), 359.1342053695754) && near(lgamma(-0.5), 1.2655121234846454));
  CHECK(lgamma(1) == 0 && lgamma(2) == 0 && near(lgamma(1 + 0x1p-20) * 0x1p20, -0.5772148805362114) && lgamma(0) == HUGE_VAL && lgamma(-4) == HUGE_VAL);
  for (i = 1; i <= 23; ++i) {
    CHECK(tgamma(i) == x);
    x *= i;
  }
  CHECK(remquo(29, 3, &quotient) == -1 && (quotient & 7) == 2 && remquo(-7, 2, &quotient) == 1 && quotient == -4);
  CHECK(remquo(1e308, 1e300, &quotient) == remainder(1e308, 1e300) && remquof(10, 3, &quotient) == 1 && quotient == 3);
  CHECK(remainder(1e308, 1e300) == -4.1525696625763965e+291);
  CHECK(is_none(nan("")) && nanf("") != 0);
  CHECK(isgreater(x, 1) && islessequal(1.0, x) && isunordered(x, NAN) && !isless(x, NAN) && !isgreaterequal(1.0, x) && islessgreater(1.0, x));
}

/* What is no number stays none, and infinite arguments have the results of ISO C, annex F. */
static void beyond_numbers(void) {
  volatile double n = NAN, inf = HUGE_VAL, zero = -0.0, eight = -8;
  CHECK(is_none(sqrt(n)) && is_none(exp(n)) && is_none(exp2(n)) && is_none(expm1(n)) && is_none(sin(n)) && is_none(sinh(n)) && is_none(cosh(n)));
  CHECK(is_none(asinh(n)) && is_none(acosh(n)) && is_none(atanh(n)) && is_none(logb(n)) && is_none(tgamma(n)) && is_none(erf(n)) && is_none(floor(n)));
  CHECK(is_none(sin(inf)) && is_none(cos(-inf)) && is_none(tan(inf)) && log2(inf) == inf && log1p(inf) == inf && logb(-inf) == inf);
  CHECK(is_none(pow(eight, 1.0 / 3)) && pow(-inf, 2.5) == inf && pow(-1, inf) == 1 && pow(zero, -3) == -inf && pow(1, n) == 1);
  CHECK(is_none(fmod(inf, 2)) && is_none(fmod(1, n)) && is_none(remainder(inf, 2)) && is_none(remainder(n, 2)) && fmod(3, inf) == 3);
  CHECK(fmin(n, 1) == 1 && fmin(1, n) == 1 && fmax(n, 1) == 1 && fmax(1, n) == 1 && is_none(fdim(n, 1)) && is_none(fdim(1, n)));
  CHECK(hypot(inf, n) == inf && is_none(hypot(1, n)) && near(atan2(inf, inf), M_PI_4) && near(atan2(-inf, -inf), -3 * M_PI_4) && is_none(atan2(n, 1)));
  CHECK(signbit(sqrt(zero)) && signbit(sin(zero)) && signbit(tan(zero)) && exp(-inf) == 0);
  /* The last that are doubles. */
  n = 709.5, inf = 1023.75;
  CHECK(near(exp(n) * 1e-300, 135498631.93146328) && near(exp2(inf) * 1e-300, 151167371.28319339) && exp2(1024) == HUGE_VAL && exp(710) == HUGE_VAL);
  CHECK(near(sinh(n + 0.75) * 1e-300, 143425303.02495123) && near(cosh(-n) * 1e-300, 67749315.96573164));
}

int main(void) {
  error_and_gamma_functions();
  beyond_numbers();
  functions();
  exact_results();
  parts();
  floats();
  neighbours();
  exit(failures);
}
