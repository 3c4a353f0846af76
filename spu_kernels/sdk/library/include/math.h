#pragma once
// Functions of floats, and those of doubles by the same arithmetic. [C17, 7.12]
//
// All are computed in double precision and truncated to a float at the end, as SPU arithmetic truncates: the error of a float function is
// below 1.01 units in the last place, for sinf(), cosf() and tanf() where |x| <= 1e6. (tests/programs compares them with the
// host's.) Double functions have some ten digits. There is no NaN in single precision: what is not defined gives 0, and what is too large
// the largest float.

#include <sys/cdefs.h>

#define M_E 2.7182818284590452354
#define M_LOG2E 1.4426950408889634074
#define M_LN2 0.69314718055994530942
#define M_LN10 2.30258509299404568402
#define M_PI 3.14159265358979323846
#define M_PI_2 1.57079632679489661923
#define M_PI_4 0.78539816339744830962
#define M_SQRT2 1.41421356237309504880
#define M_SQRT1_2 0.70710678118654752440
#define HUGE_VALF 3.40282346638528859812e38f
#define HUGE_VAL __builtin_huge_val()

__BEGIN_DECLS
#define SC_FUNCTION_OF_1(name) \
  double name(double x);       \
  float name##f(float x);
#define SC_FUNCTION_OF_2(name)     \
  double name(double x, double y); \
  float name##f(float x, float y);
SC_FUNCTION_OF_1(sqrt)
SC_FUNCTION_OF_1(cbrt)
SC_FUNCTION_OF_1(exp)
SC_FUNCTION_OF_1(exp2)
SC_FUNCTION_OF_1(log)
SC_FUNCTION_OF_1(log2)
SC_FUNCTION_OF_1(log10)
SC_FUNCTION_OF_1(sin)
SC_FUNCTION_OF_1(cos)
SC_FUNCTION_OF_1(tan)
SC_FUNCTION_OF_1(asin)
SC_FUNCTION_OF_1(acos)
SC_FUNCTION_OF_1(atan)
SC_FUNCTION_OF_1(sinh)
SC_FUNCTION_OF_1(cosh)
SC_FUNCTION_OF_1(tanh)
SC_FUNCTION_OF_1(floor)
SC_FUNCTION_OF_1(ceil)
SC_FUNCTION_OF_1(trunc)
SC_FUNCTION_OF_1(round)
SC_FUNCTION_OF_1(fabs)
SC_FUNCTION_OF_2(pow)
SC_FUNCTION_OF_2(atan2)
SC_FUNCTION_OF_2(hypot)
SC_FUNCTION_OF_2(fmod)
SC_FUNCTION_OF_2(fmin)
SC_FUNCTION_OF_2(fmax)
SC_FUNCTION_OF_2(copysign)
#undef SC_FUNCTION_OF_1
#undef SC_FUNCTION_OF_2
float ldexpf(float x, int exponent);
double ldexp(double x, int exponent);
float modff(float x, float* whole);
double modf(double x, double* whole);
__END_DECLS
