// math.h, in double precision; each float function truncates the result of its namesake.

#include <emmintrin.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

namespace {

constexpr double kLn2 = 0x1.62E42FEFA39EFp-1, kLog2e = 0x1.71547652B82FEp0, kPi = 0x1.921FB54442D18p1;
constexpr double kLargest = HUGE_VALF;

int64_t bits_of(double x) {
  int64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}
double of_bits(int64_t bits) {
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/// 2^n, of which the exponent is cut to that of a double.
double power_of_2(int64_t n) {
  if (n < -1022) return 0;
  return of_bits(((n > 1023 ? 1023 : n) + 1023) << 52);
}

template <int N>
double polynomial(double x, const double (&coefficients)[N]) {
  double sum = coefficients[N - 1];
  for (int i = N - 2; i >= 0; --i) sum = sum * x + coefficients[i];
  return sum;
}

/// The nearest whole number, of halves the one away from zero.
double nearest(double x) {
  return x < 0 ? static_cast<double>(static_cast<int64_t>(x - 0.5))
               : static_cast<double>(static_cast<int64_t>(x + 0.5));
}

/// x = quadrant pi / 2 + rest. Three parts of pi / 2, of which the first two have 33 bits, so that their products are exact.
double reduce(double x, int& quadrant) {
  const double k = nearest(x * (2 / kPi));
  quadrant = static_cast<int>(static_cast<int64_t>(k) & 3);
  return x - k * 0x1.921FB544p0 - k * 0x1.0B4611A6p-34 - k * 0x1.3198A2E037073p-69;
}
/// |x| <= pi / 4: the series, whose next term is below 1e-13.
double sine(double x) {
  const double s = x * x;
  return x + x * s *
                 polynomial(s, {-1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800,
                                1.0 / 6227020800.0});
}
double cosine(double x) {
  const double s = x * x;
  return 1 + s * polynomial(s, {-1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600,
                                -1.0 / 87178291200.0});
}
double sine_in(int quadrant, double x) {
  const double value = (quadrant & 1) != 0 ? cosine(x) : sine(x);
  return (quadrant & 2) != 0 ? -value : value;
}

}  // namespace

extern "C" {

double sqrt(double x) { return x < 0 ? 0 : _mm_cvtsd_f64(_mm_sqrt_sd(_mm_setzero_pd(), _mm_set_sd(x))); }
double fabs(double x) { return of_bits(bits_of(x) & INT64_MAX); }
double copysign(double x, double y) { return of_bits((bits_of(x) & INT64_MAX) | (bits_of(y) & INT64_MIN)); }
double fmin(double x, double y) { return x < y ? x : y; }
double fmax(double x, double y) { return x > y ? x : y; }

double trunc(double x) {
  return fabs(x) < 0x1p52 ? copysign(static_cast<double>(static_cast<int64_t>(x)), x) : x;
}
double floor(double x) {
  const double whole = trunc(x);
  return whole > x ? whole - 1 : whole;
}
double ceil(double x) { return -floor(-x); }
double round(double x) {
  const double whole = trunc(x);
  return fabs(x - whole) < 0.5 ? whole : whole + copysign(1, x);
}
double modf(double x, double* whole) {
  *whole = trunc(x);
  return x - *whole;
}
double ldexp(double x, int exponent) {
  // In two steps, as 2^exponent may be no double.
  return x * power_of_2(exponent / 2) * power_of_2(exponent - exponent / 2);
}

/// The remainder of a division by subtraction, exact at each step.
double fmod(double x, double y) {
  const double divisor = fabs(y);
  double rest = fabs(x);
  if (divisor == 0) return 0;
  while (rest >= divisor) {
    const int64_t difference = (bits_of(rest) >> 52) - (bits_of(divisor) >> 52);
    double part = divisor * power_of_2(difference);
    if (part > rest) part *= 0.5;
    rest -= part;
  }
  return copysign(rest, x);
}

double exp(double x) {
  if (x > 709) return HUGE_VAL;
  if (x < -708) return 0;
  const double k = nearest(x * kLog2e);
  const double r = x - k * 0x1.62E42FEEp-1 - k * 0x1.A39EF35793C76p-33;
  return power_of_2(static_cast<int64_t>(k)) *
         polynomial(r, {1, 1, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320,
                        1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800});
}
double exp2(double x) { return exp(x * kLn2); }

double log(double x) {
  if (x <= 0) return -kLargest;
  int64_t exponent = (bits_of(x) >> 52) - 1023;
  double m = of_bits((bits_of(x) & 0xFFFFFFFFFFFFF) | (int64_t{1023} << 52));
  if (m > M_SQRT2) {
    m *= 0.5;
    ++exponent;
  }
  const double s = (m - 1) / (m + 1), q = s * s;
  const double series =
      polynomial(q, {1, 1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9, 1.0 / 11, 1.0 / 13, 1.0 / 15, 1.0 / 17});
  return static_cast<double>(exponent) * kLn2 + 2 * s * series;
}
double log2(double x) { return x <= 0 ? -kLargest : log(x) * kLog2e; }
double log10(double x) { return x <= 0 ? -kLargest : log(x) * (1 / M_LN10); }

double pow(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (x == 0) return y > 0 ? 0 : HUGE_VAL;
  const double size = exp(y * log(fabs(x)));
  if (x > 0) return size;
  if (trunc(y) != y) return 0;
  return fmod(y, 2) == 0 ? size : -size;
}
double cbrt(double x) { return x == 0 ? x : copysign(exp(log(fabs(x)) / 3), x); }
double hypot(double x, double y) { return sqrt(x * x + y * y); }

double sin(double x) {
  int quadrant;
  const double rest = reduce(x, quadrant);
  return sine_in(quadrant, rest);
}
double cos(double x) {
  int quadrant;
  const double rest = reduce(x, quadrant);
  return sine_in(quadrant + 1, rest);
}
double tan(double x) {
  int quadrant;
  const double rest = reduce(x, quadrant);
  return sine_in(quadrant, rest) / sine_in(quadrant + 1, rest);
}

double atan(double x) {
  const double size = fabs(x);
  // Beyond tan(pi / 8) by the angles between it and pi / 4 or pi / 2.
  const double base = size > 2.414213562373095 ? kPi / 2 : size > 0.4142135623730950 ? kPi / 4 : 0;
  const double t = size > 2.414213562373095    ? -1 / size
                   : size > 0.4142135623730950 ? (size - 1) / (size + 1)
                                               : size;
  const double q = t * t;
  const double series = polynomial(q, {1, -1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13,
                                       -1.0 / 15, 1.0 / 17, -1.0 / 19, 1.0 / 21, -1.0 / 23, 1.0 / 25});
  return copysign(base + t * series, x);
}
double atan2(double y, double x) {
  if (x == 0 && y == 0) return 0;
  if (fabs(y) > fabs(x)) return copysign(kPi / 2, y) - atan(x / y);
  const double angle = atan(y / x);
  return x > 0 ? angle : angle + copysign(kPi, y);
}
double asin(double x) { return fabs(x) > 1 ? 0 : atan2(x, sqrt((1 - x) * (1 + x))); }
double acos(double x) { return fabs(x) > 1 ? 0 : atan2(sqrt((1 - x) * (1 + x)), x); }

double sinh(double x) {
  if (fabs(x) < 0.5) {  // where the difference of exponentials would lose digits
    const double s = x * x;
    return x + x * s * polynomial(s, {1.0 / 6, 1.0 / 120, 1.0 / 5040, 1.0 / 362880, 1.0 / 39916800});
  }
  const double e = exp(fabs(x));
  return copysign((e - 1 / e) / 2, x);
}
double cosh(double x) {
  const double e = exp(fabs(x));
  return (e + 1 / e) / 2;
}
double tanh(double x) { return fabs(x) > 20 ? copysign(1, x) : sinh(x) / cosh(x); }

static float to_float(double x) {
  return static_cast<float>(x > kLargest ? kLargest : x < -kLargest ? -kLargest : x);
}

#define SC_FLOAT_1(name) \
  float name##f(float x) { return to_float(name(x)); }
#define SC_FLOAT_2(name) \
  float name##f(float x, float y) { return to_float(name(x, y)); }
SC_FLOAT_1(sqrt)
SC_FLOAT_1(cbrt)
SC_FLOAT_1(exp)
SC_FLOAT_1(exp2)
SC_FLOAT_1(log)
SC_FLOAT_1(log2)
SC_FLOAT_1(log10)
SC_FLOAT_1(sin)
SC_FLOAT_1(cos)
SC_FLOAT_1(tan)
SC_FLOAT_1(asin)
SC_FLOAT_1(acos)
SC_FLOAT_1(atan)
SC_FLOAT_1(sinh)
SC_FLOAT_1(cosh)
SC_FLOAT_1(tanh)
SC_FLOAT_1(floor)
SC_FLOAT_1(ceil)
SC_FLOAT_1(trunc)
SC_FLOAT_1(round)
SC_FLOAT_1(fabs)
SC_FLOAT_2(pow)
SC_FLOAT_2(atan2)
SC_FLOAT_2(hypot)
SC_FLOAT_2(fmod)
SC_FLOAT_2(fmin)
SC_FLOAT_2(fmax)
SC_FLOAT_2(copysign)
float ldexpf(float x, int exponent) { return to_float(ldexp(x, exponent)); }
float modff(float x, float* whole) {
  *whole = truncf(x);
  return x - *whole;
}

}  // extern "C"
