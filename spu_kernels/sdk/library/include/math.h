#pragma once
// Functions of floats, and those of doubles by the same arithmetic. [C17, 7.12]
//
// All are computed in double precision and rounded once. The error of a float function of one argument is at most 0.50005 units in
// the last place, measured for all 2^32 arguments (`ci/float-functions`), with these rules: denormal arguments and results are 0; there
// are no NaN and no infinities in single precision, so what is not defined gives 0, what is too large the largest float, and an argument
// of 2^128 or more counts as the largest float. An SPU built from the same source has the same bits.
//
// Of double functions sqrt(), pow(), log10() and hypot() err by at most 0.52 units in the last place, so that results that are whole
// numbers are exact. The others have some twelve digits; sin(), cos() and tan() of doubles from 2^20 on take the first 24 bits of their
// argument. lgamma() of negative numbers, and its float twin, have twelve digits behind the point. NaN, infinities and zeros as
// arguments of double functions have the results of annex F.

#include <sys/cdefs.h>

#define M_E 2.7182818284590452354
#define M_LOG2E 1.4426950408889634074
#define M_LOG10E 0.43429448190325182765
#define M_LN2 0.69314718055994530942
#define M_LN10 2.30258509299404568402
#define M_PI 3.14159265358979323846
#define M_PI_2 1.57079632679489661923
#define M_PI_4 0.78539816339744830962
#define M_1_PI 0.31830988618379067154
#define M_2_PI 0.63661977236758134308
#define M_2_SQRTPI 1.12837916709551257390
#define M_SQRT2 1.41421356237309504880
#define M_SQRT1_2 0.70710678118654752440
#define HUGE_VALF 3.40282346638528859812e38f
#define HUGE_VAL __builtin_huge_val()
#define INFINITY __builtin_inff()
#define NAN __builtin_nanf("")
#define FP_ILOGB0 (-2147483647 - 1)
#define FP_NAN 0
#define FP_INFINITE 1
#define FP_ZERO 2
#define FP_SUBNORMAL 3
#define FP_NORMAL 4
#define fpclassify(x) __builtin_fpclassify(FP_NAN, FP_INFINITE, FP_NORMAL, FP_SUBNORMAL, FP_ZERO, x)
#define isfinite(x) __builtin_isfinite(x)
#define isinf(x) __builtin_isinf_sign(x)
#define isnan(x) __builtin_isnan(x)
#define isnormal(x) __builtin_isnormal(x)
#define signbit(x) __builtin_signbit(x)
#define isgreater(x, y) __builtin_isgreater(x, y)
#define isgreaterequal(x, y) __builtin_isgreaterequal(x, y)
#define isless(x, y) __builtin_isless(x, y)
#define islessequal(x, y) __builtin_islessequal(x, y)
#define islessgreater(x, y) __builtin_islessgreater(x, y)
#define isunordered(x, y) __builtin_isunordered(x, y)

__BEGIN_DECLS
#define SC_FUNCTION_OF_1(name) \
  double name(double x_);      \
  float name##f(float x_);
#define SC_FUNCTION_OF_2(name)       \
  double name(double x_, double y_); \
  float name##f(float x_, float y_);
SC_FUNCTION_OF_1(sqrt)
SC_FUNCTION_OF_1(cbrt)
SC_FUNCTION_OF_1(exp)
SC_FUNCTION_OF_1(exp2)
SC_FUNCTION_OF_1(expm1)
SC_FUNCTION_OF_1(log)
SC_FUNCTION_OF_1(log2)
SC_FUNCTION_OF_1(log10)
SC_FUNCTION_OF_1(log1p)
SC_FUNCTION_OF_1(logb)
SC_FUNCTION_OF_1(sin)
SC_FUNCTION_OF_1(cos)
SC_FUNCTION_OF_1(tan)
SC_FUNCTION_OF_1(asin)
SC_FUNCTION_OF_1(acos)
SC_FUNCTION_OF_1(atan)
SC_FUNCTION_OF_1(sinh)
SC_FUNCTION_OF_1(cosh)
SC_FUNCTION_OF_1(tanh)
SC_FUNCTION_OF_1(asinh)
SC_FUNCTION_OF_1(acosh)
SC_FUNCTION_OF_1(atanh)
SC_FUNCTION_OF_1(erf)
SC_FUNCTION_OF_1(erfc)
SC_FUNCTION_OF_1(lgamma)
SC_FUNCTION_OF_1(tgamma)
SC_FUNCTION_OF_1(floor)
SC_FUNCTION_OF_1(ceil)
SC_FUNCTION_OF_1(trunc)
SC_FUNCTION_OF_1(round)
SC_FUNCTION_OF_1(rint)
SC_FUNCTION_OF_1(nearbyint)
SC_FUNCTION_OF_1(fabs)
SC_FUNCTION_OF_2(pow)
SC_FUNCTION_OF_2(atan2)
SC_FUNCTION_OF_2(hypot)
SC_FUNCTION_OF_2(fmod)
SC_FUNCTION_OF_2(remainder)
SC_FUNCTION_OF_2(fmin)
SC_FUNCTION_OF_2(fmax)
SC_FUNCTION_OF_2(fdim)
SC_FUNCTION_OF_2(copysign)
SC_FUNCTION_OF_2(nextafter)
#undef SC_FUNCTION_OF_1
#undef SC_FUNCTION_OF_2
float ldexpf(float x_, int exponent);
double ldexp(double x_, int exponent);
float scalbnf(float x_, int exponent);
double scalbn(double x_, int exponent);
float scalblnf(float x_, long exponent);
double scalbln(double x_, long exponent);
float frexpf(float x_, int* exponent);
double frexp(double x_, int* exponent);
int ilogbf(float x_);
int ilogb(double x_);
float fmaf(float x_, float y_, float z_);
double fma(double x_, double y_, double z_);
long lrintf(float x_);
long lrint(double x_);
long long llrintf(float x_);
long long llrint(double x_);
long lroundf(float x_);
long lround(double x_);
long long llroundf(float x_);
long long llround(double x_);
/// NaN; the text is not looked at.
static __inline__ __attribute__((unused)) double nan(const char* text) {
  (void)text;
  return __builtin_nan("");
}
static __inline__ __attribute__((unused)) float nanf(const char* text) {
  (void)text;
  return NAN;
}
double remquo(double x_, double y_, int* quotient);
float remquof(float x_, float y_, int* quotient);
float modff(float x_, float* whole);
double modf(double x_, double* whole);
__END_DECLS
