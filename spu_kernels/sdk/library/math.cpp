// math.h: in double precision, rounded to nearest as an SPU's doubles are; each float function rounds the result of its namesake once.
//
// The same source makes the same bits on an SPU (tests/programs compares them): nothing is fused, and square roots and quotients are
// exactly rounded on both.

#include <math.h>
#include <stdint.h>

#ifndef __x86_64__
#include <spu_intrinsics.h>
#define SC_REGISTER "r"
#else
#include <immintrin.h>
#define SC_REGISTER "x"
#endif

namespace {

/// A kernel for the host truncates, as its single precision does; as long as this lives doubles round to nearest.
class DoubleArithmetic {
 public:
#ifndef __x86_64__
  DoubleArithmetic() {}
#else
  DoubleArithmetic() {
    const unsigned int nearest = 0x1FC0;  // all exceptions masked, denormal operands zero
    asm volatile("stmxcsr %0\n\tldmxcsr %1" : "=m"(before_) : "m"(nearest) : "memory");
  }
  ~DoubleArithmetic() { asm volatile("ldmxcsr %0" : : "m"(before_) : "memory"); }

 private:
  unsigned int before_;
#endif
};

/// A value that no compiler knows, so that what is made of it is computed where it stands.
template <class T>
inline T as_it_is_here(T x) {
  asm volatile("" : "+" SC_REGISTER(x) : : "memory");
  return x;
}

constexpr double kLn2 = 0x1.62E42FEFA39EFp-1, kLog2e = 0x1.71547652B82FEp0, kPi = 0x1.921FB54442D18p1;
constexpr double kSqrt2 = 0x1.6A09E667F3BCDp0, kTwoOverPi = 2 / kPi;
// Coefficients are constants: a compiler that must not round for itself would divide at each call.
constexpr double kExponential[] = {
    1,          1.0 / 2,     1.0 / 6,      1.0 / 24,      1.0 / 120,      1.0 / 720,
    1.0 / 5040, 1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600};
constexpr double kLogarithm[] = {1,        1.0 / 3,  1.0 / 5,  1.0 / 7, 1.0 / 9,
                                 1.0 / 11, 1.0 / 13, 1.0 / 15, 1.0 / 17};
constexpr double kSine[] = {-1.0 / 6,     1.0 / 120,       -1.0 / 5040,
                            1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800.0};
constexpr double kCosine[] = {-1.0 / 2,       1.0 / 24,        -1.0 / 720,          1.0 / 40320,
                              -1.0 / 3628800, 1.0 / 479001600, -1.0 / 87178291200.0};
constexpr double kArcTangent[] = {1,         -1.0 / 3, 1.0 / 5,   -1.0 / 7, 1.0 / 9,   -1.0 / 11, 1.0 / 13,
                                  -1.0 / 15, 1.0 / 17, -1.0 / 19, 1.0 / 21, -1.0 / 23, 1.0 / 25};
constexpr double kHyperbolicSine[] = {1.0 / 6, 1.0 / 120, 1.0 / 5040, 1.0 / 362880, 1.0 / 39916800};
constexpr double kLargest = 0x1.FFFFFEp127, kSmallest = 0x1p-126;  // of floats
constexpr double kLargestDouble = 0x1.FFFFFFFFFFFFFp1023;

int64_t bits_of(double x) {
  int64_t bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  return bits;
}
double of_bits(int64_t bits) {
  double x;
  __builtin_memcpy(&x, &bits, sizeof x);
  return x;
}

bool is_nan(double x) { return (bits_of(x) & INT64_MAX) > 0x7FF0000000000000; }

/// The numbers in their order: 0 has the place 0, the one above it 1.
int64_t place_of(double x) {
  const int64_t bits = bits_of(x);
  return bits < 0 ? INT64_MIN - bits : bits;
}
double at_place(int64_t place) { return of_bits(place < 0 ? INT64_MIN - place : place); }

/// Likewise of floats: above 0 lies the smallest normal one, and nothing above the largest.
constexpr int32_t kDenormals = 0x7FFFFF, kLastPlace = 0x7F7FFFFF - kDenormals;
int32_t place_of(float x) {
  int32_t bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  const int32_t place = (bits & INT32_MAX) - kDenormals;
  const int32_t within = place < 0 ? 0 : place > kLastPlace ? kLastPlace : place;
  return bits < 0 ? -within : within;
}
float float_at_place(int32_t place) {
  const int32_t size = place < 0 ? -place : place;
  const int32_t within = size > kLastPlace ? kLastPlace : size;
  const int32_t bits = within == 0 ? 0 : (within + kDenormals) | (place < 0 ? INT32_MIN : 0);
  float x;
  __builtin_memcpy(&x, &bits, sizeof x);
  return x;
}

double size_of(double x) { return of_bits(bits_of(x) & INT64_MAX); }
double with_sign_of(double x, double y) {
  return of_bits((bits_of(x) & INT64_MAX) | (bits_of(y) & INT64_MIN));
}

/// 2^n, of which the exponent is cut to that of a double.
double power_of_2(int64_t n) {
  if (n < -1022) return 0;
  return of_bits(((n > 1023 ? 1023 : n) + 1023) << 52);
}
/// x 2^n, n in -1022..1024: 2^1024 is no double, while half of it is one.
double times_power_of_2(double x, int64_t n) {
  return n > 1023 ? x * 2 * power_of_2(1023) : x * power_of_2(n);
}

template <int N>
double polynomial(double x, const double (&coefficients)[N]) {
  double sum = coefficients[N - 1];
  for (int i = N - 2; i >= 0; --i) sum = sum * x + coefficients[i];
  return sum;
}

/// The nearest whole number, of halves the one away from zero. |x| < 2^62
int64_t nearest(double x) { return static_cast<int64_t>(x < 0 ? x - 0.5 : x + 0.5); }

// ---- whole numbers and parts

double truncated(double x) {
  return size_of(x) < 0x1p52 ? with_sign_of(static_cast<double>(static_cast<int64_t>(x)), x) : x;
}
double floor_of(double x) {
  const double whole = truncated(x);
  return whole > x ? whole - 1 : whole;
}
double ceil_of(double x) { return -floor_of(-x); }
double rounded(double x) {
  const double whole = truncated(x);
  return size_of(x - whole) < 0.5 ? whole : whole + with_sign_of(1, x);
}
/// Halves to the even one.
double rounded_to_even(double x) {
  const double whole = rounded(x);
  if (size_of(x - truncated(x)) != 0.5) return whole;
  return 2 * rounded(x / 2) == whole ? whole : truncated(x);
}

double scaled(double x, int exponent) {
  const int cut = exponent > 2200 ? 2200 : exponent < -2200 ? -2200 : exponent;
  // In three steps, as 2^exponent may be no double.
  const int third = cut / 3;
  return x * power_of_2(third) * power_of_2(third) * power_of_2(cut - 2 * third);
}

/// x = part * 2^exponent, |part| in [1/2, 1).
double parted(double x, int* exponent) {
  *exponent = 0;
  if (x == 0 || size_of(x) > kLargestDouble) return x;
  *exponent = static_cast<int>(bits_of(x) >> 52 & 0x7FF) - 1022;
  return of_bits((bits_of(x) & ~(int64_t{0x7FF} << 52)) | (int64_t{1022} << 52));
}

/// The remainder of a division by subtraction, exact at each step.
double remainder_towards_zero(double x, double y) {
  const double divisor = size_of(y);
  double rest = size_of(x);
  if (divisor == 0 || rest > kLargestDouble) return 0;
  while (rest >= divisor) {
    const int64_t difference = (bits_of(rest) >> 52) - (bits_of(divisor) >> 52);
    double part = divisor * power_of_2(difference);
    if (part > rest) part *= 0.5;
    rest -= part;
  }
  return with_sign_of(rest, x);
}

/// Of the quotient that is nearest, halves to even.
double remainder_to_nearest(double x, double y) {
  const double divisor = size_of(y), twice = divisor + divisor;
  double rest = size_of(twice <= kLargestDouble ? remainder_towards_zero(x, twice) : x);
  if (divisor == 0) return 0;
  if (rest > 0.5 * divisor) {
    rest -= divisor;
    if (rest >= 0.5 * divisor) rest -= divisor;
  }
  return bits_of(x) < 0 ? -rest : rest;
}

/// a * b + c, rounded once.
double fused(double a, double b, double c) {
#ifndef __x86_64__
  return spu_extract(spu_madd(spu_promote(a, 0), spu_promote(b, 0), spu_promote(c, 0)), 0);
#else
  return _mm_cvtsd_f64(_mm_fmadd_sd(_mm_set_sd(a), _mm_set_sd(b), _mm_set_sd(c)));
#endif
}

// ---- sums of two doubles, where a result is to be rounded once

struct Pair {
  double high, low;  ///< |low| is at most half a unit in the last place of `high`
};
/// a + b for |a| >= |b|, exact. [Dekker 1971] documented
Pair sum_of_ordered(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}
/// a + b, exact. [Knuth, TAOCP 2, 4.2.2] documented
Pair sum(double a, double b) {
  const double both = a + b, of_b = both - a;
  return {both, (a - (both - of_b)) + (b - of_b)};
}
/// a * b, exact.
Pair product(double a, double b) {
  const double both = a * b;
  return {both, fused(a, b, -both)};
}
Pair product(Pair a, Pair b) {
  const Pair both = product(a.high, b.high);
  return sum_of_ordered(both.high, both.low + (a.high * b.low + a.low * b.high));
}

// ---- roots

#ifndef __x86_64__

/// Correctly rounded: from an estimate the double below the root, and then by the sign of a residue that is exact.
double root_of(double x) {
  if (!(x > 0) || x > kLargestDouble) return x > 0 ? x : 0;
  int exponent;
  double part = parted(x, &exponent);
  if ((exponent & 1) != 0) {
    part *= 0.5;
    ++exponent;
  }
  // 1/4 <= part < 1. One over its root, to 12 bits and then thrice as many digits.
  double r = static_cast<double>(spu_extract(spu_rsqrte(spu_promote(static_cast<float>(part), 0)), 0));
  for (int i = 0; i < 3; ++i) r = r * (1.5 - 0.5 * part * r * r);
  double root = part * r;
  root = root + 0.5 * r * fused(-root, root, part);
  // Now within a unit in the last place. root - u/2 < sqrt(part) < root + u/2 by squares: (root +- u/2)^2 = root^2 +- u root + u^2/4.
  const double unit = 0x1p-53;
  for (;;) {
    const double rest = fused(-root, root, part);
    if (rest > root * unit)
      root += unit;
    else if (rest <= -(root * unit))
      root -= unit;
    else
      break;
  }
  return scaled(root, exponent / 2);
}
#else
double root_of(double x) {
  return !(x > 0) ? 0 : _mm_cvtsd_f64(_mm_sqrt_sd(_mm_setzero_pd(), _mm_set_sd(x)));
}
#endif

// ---- exponentials

/// e^r - 1 for |r| <= ln 2 / 2: the series, whose next term is below 1e-14 of it.
double small_exponential(double r) { return r * polynomial(r, kExponential); }

double exponential(double x) {
  if (x > 709.782712893384) return HUGE_VAL;
  if (!(x > -708)) return 0;
  const int64_t k = nearest(x * kLog2e);
  const double n = static_cast<double>(k);
  const double r = x - n * 0x1.62E42FEEp-1 - n * 0x1.A39EF35793C76p-33;
  return times_power_of_2(1 + small_exponential(r), k);
}
double exponential_of_2(double x) {
  if (x >= 1024) return HUGE_VAL;
  if (!(x > -1022)) return 0;
  const int64_t k = nearest(x);
  return times_power_of_2(1 + small_exponential((x - static_cast<double>(k)) * kLn2), k);
}
double exponential_less_1(double x) { return size_of(x) < 0.34 ? small_exponential(x) : exponential(x) - 1; }

/// m of x = m 2^exponent, of x > 0. 1/sqrt(2) < m <= sqrt(2)
double parted_near_1(double x, int* exponent) {
  const double m = 2 * parted(x, exponent);
  if (m > kSqrt2) return 0.5 * m;
  --*exponent;
  return m;
}

/// ln x = exponent ln 2 + ln m, of x > 0.
struct Logarithm {
  double exponent, of_part;
};
Logarithm logarithm(double x) {
  int exponent;
  const double m = parted_near_1(x, &exponent);
  const double s = (m - 1) / (m + 1), q = s * s;
  const double series = polynomial(q, kLogarithm);
  return {static_cast<double>(exponent), 2 * s * series};
}
/// What no positive number has: of 0 the largest number below zero, of others 0.
double no_logarithm(double x) { return x == 0 ? -kLargest : 0; }

double natural_logarithm(double x) {
  if (!(x > 0)) return no_logarithm(x);
  if (x > kLargestDouble) return x;
  const Logarithm l = logarithm(x);
  return l.exponent * kLn2 + l.of_part;
}
double logarithm_to_2(double x) {
  if (!(x > 0)) return no_logarithm(x);
  if (x > kLargestDouble) return x;
  const Logarithm l = logarithm(x);
  return l.exponent + l.of_part * kLog2e;
}
/// ln (1 + x), by the logarithm of what 1 + x is rounded to.
double logarithm_of_1_and(double x) {
  if (!(x > -1)) return no_logarithm(x + 1);
  if (x > kLargestDouble) return x;
  const double u = 1 + x;
  return u == 1 ? x : natural_logarithm(u) * (x / (u - 1));
}

// ---- powers and decimal logarithms, whose results are whole numbers where they are: with pairs, rounded once

constexpr Pair kLn2Pair{
    0x1.62E42FEFA3800p-1,
    0x1.EF35793C76730p-45};  // the first has 42 bits: its product with an exponent is exact
constexpr Pair kOverLn10{0x1.BCB7B1526E50Ep-2, 0x1.95355BAAAFAD3p-57};
/// Of s^7 and on in artanh s, and of r^3 and on in e^r.
constexpr double kLogarithmTail[] = {1.0 / 7,  1.0 / 9,  1.0 / 11, 1.0 / 13, 1.0 / 15, 1.0 / 17,
                                     1.0 / 19, 1.0 / 21, 1.0 / 23, 1.0 / 25, 1.0 / 27};
constexpr double kExponentialTail[] = {
    1.0 / 6,          1.0 / 24,          1.0 / 120,          1.0 / 720,      1.0 / 5040,
    1.0 / 40320,      1.0 / 362880,      1.0 / 3628800,      1.0 / 39916800, 1.0 / 479001600,
    1.0 / 6227020800, 1.0 / 87178291200, 1.0 / 1307674368000};
constexpr Pair kThird{0x1.5555555555555p-2, 0x1.5555555555555p-56},
    kFifth{0x1.999999999999Ap-3, -0x1.999999999999Ap-57};

/// ln x to 2^-65 of it, of 0 < x < infinity: exponent ln 2 + 2 artanh s, s = (m - 1) / (m + 1).
Pair precise_logarithm(double x) {
  int exponent;
  const double m = parted_near_1(x, &exponent);
  const Pair above = sum(m, 1);
  const double below = m - 1, quotient = below / above.high;
  const Pair s =
      sum_of_ordered(quotient, (fused(-quotient, above.high, below) - quotient * above.low) / above.high);
  const Pair q = product(s, s);
  // artanh s = s + s q (1/3 + q (1/5 + q ...))
  const Pair fifth = sum_of_ordered(kFifth.high, kFifth.low + q.high * polynomial(q.high, kLogarithmTail));
  const Pair rest = product(q, fifth), third = sum_of_ordered(kThird.high, rest.high);
  const Pair tail = product(product(s, q), {third.high, third.low + (kThird.low + rest.low)});
  const Pair area = sum_of_ordered(s.high, tail.high);
  const double e = static_cast<double>(exponent);
  const Pair whole = sum(e * kLn2Pair.high, 2 * area.high);
  return sum_of_ordered(whole.high, whole.low + (e * kLn2Pair.low + 2 * (area.low + (s.low + tail.low))));
}

/// e^x to 2^-60 of it before it is rounded.
double exponential_of(Pair x) {
  const int64_t k = nearest(x.high * kLog2e);
  const double n = static_cast<double>(k);
  // What is left of the first part is exact.
  const Pair r = sum(x.high - n * kLn2Pair.high, x.low - n * kLn2Pair.low);
  const Pair square = product(r.high, r.high);
  const double low = r.low + (0.5 * square.low + r.high * r.low) +
                     r.high * square.high * polynomial(r.high, kExponentialTail);
  const Pair second = sum_of_ordered(r.high, 0.5 * square.high), first = sum_of_ordered(1, second.high);
  const double part = first.high + (first.low + (second.low + low));
  return times_power_of_2(part, k);
}

double logarithm_to_10(double x) {
  if (!(x > 0)) return no_logarithm(x);
  if (x > kLargestDouble) return x;
  const Pair both = product(precise_logarithm(x), kOverLn10);
  return both.high + both.low;
}

double power(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (x != x || y != y) return x + y;
  const bool whole = truncated(y) == y;
  const bool is_negative = bits_of(x) < 0 && whole && remainder_towards_zero(y, 2) != 0;
  if (x == 0) return with_sign_of(y > 0 ? 0 : HUGE_VAL, is_negative ? -1 : 1);
  if (x == -1 && size_of(y) > kLargestDouble) return 1;
  if (x < 0 && x >= -kLargestDouble && !whole) return 0;
  double size = size_of(x);
  if (size > kLargestDouble) {
    size = y > 0 ? HUGE_VAL : 0;
  } else {
    const Pair logarithm_of_x = precise_logarithm(size);
    const double about = y * logarithm_of_x.high;
    if (about > 709.8) {
      size = HUGE_VAL;
    } else if (!(about > -708.3965)) {
      size = 0;
    } else {
      size = exponential_of(product({y, 0}, logarithm_of_x));
      if (size < 0x1p-1022) size = 0;
    }
  }
  return is_negative ? -size : size;
}

/// From an estimate by Newton's iteration, once, so that cubes of whole numbers have whole roots.
double cube_root(double x) {
  if (x == 0 || size_of(x) > kLargestDouble) return x;
  const double size = size_of(x), root = exponential(natural_logarithm(size) / 3);
  return with_sign_of(root - (root * root * root - size) / (3 * root * root), x);
}

/// Rounded nearly once, of numbers whose squares are too large or too small, too.
double hypotenuse(double x, double y) {
  const double larger = size_of(x) > size_of(y) ? size_of(x) : size_of(y);
  const double smaller = size_of(x) > size_of(y) ? size_of(y) : size_of(x);
  if (larger + smaller == larger || larger > kLargestDouble) return larger;
  int exponent;
  const double a = parted(larger, &exponent), b = scaled(smaller, -exponent);
  const Pair a_square = product(a, a), b_square = product(b, b);
  const Pair squares = sum_of_ordered(a_square.high, b_square.high);
  const double root = root_of(squares.high);
  const double rest = fused(-root, root, squares.high) + (squares.low + (a_square.low + b_square.low));
  return scaled(root + rest / (2 * root), exponent);
}

// ---- angles

/// 2 / pi behind its point.
constexpr uint32_t kDigitsOfTwoOverPi[] = {0xA2F9836E, 0x4E441529, 0xFC2757D1, 0xF534DDC0,
                                           0xDB629599, 0x3C439041, 0xFE5163AB};

/// x = quadrant pi / 2 + rest.
struct Angle {
  int quadrant;
  double rest;
};

/// |x| >= 2^20 and a float: the 24 bits of x times those 96 bits of 2 / pi that are neither above a turn nor below notice.
Angle reduce_large(double x) {
  // Of the last of 24 bits; -3..104.
  const int exponent = static_cast<int>(bits_of(x) >> 52 & 0x7FF) - 1023 - 23;
  const uint64_t m = static_cast<uint64_t>((bits_of(x) & 0xFFFFFFFFFFFFF) >> 29 | 1 << 23);
  // The product's bits from 4 on: they start `skipped` bits behind the point of 2 / pi.
  const int skipped = exponent > 2 ? exponent - 2 : 0;
  uint32_t window[3];
  for (int i = 0; i < 3; ++i) {
    const uint32_t* const word = kDigitsOfTwoOverPi + skipped / 32 + i;
    const int shift = skipped % 32;
    window[i] = shift == 0 ? word[0] : word[0] << shift | word[1] >> (32 - shift);
  }
  // m * window as a number of 96 bits; what is above it are whole turns.
  const uint64_t low = m * window[2], middle = m * window[1] + (low >> 32);
  const uint64_t high = m * window[0] + (middle >> 32);
  // In front of the point there are `whole` bits of the 96, and all that is above them.
  const int whole = exponent - skipped;  // -3..2
  const uint64_t above = high >> 32;
  uint64_t behind = high << 32 | (middle & 0xFFFFFFFF);
  int quadrant;
  if (whole > 0) {
    quadrant = static_cast<int>(above << whole | behind >> (64 - whole));
    behind = behind << whole | (low & 0xFFFFFFFF) >> (32 - whole);
  } else {
    quadrant = static_cast<int>(above >> -whole);
    if (whole < 0) behind = above << (64 + whole) | behind >> -whole;
  }
  const bool to_next = behind >> 63 != 0;  // it is nearer
  if (to_next) {
    ++quadrant;
    behind = 0 - behind;
  }
  const double size = static_cast<double>(static_cast<int64_t>(behind >> 1)) * 0x1p-63;
  const double fraction = to_next ? -size : size;
  const double rest = fraction * (kPi / 2);
  return x < 0 ? Angle{-quadrant & 3, -rest} : Angle{quadrant & 3, rest};
}

/// pi / 2 in three parts, of which the first two have 33 bits, so that their products are exact. Of what is larger, the first 24 bits and
/// the others by themselves.
Angle reduce(double x) {
  if (size_of(x) > kLargest) return {0, 0};
  if (size_of(x) >= 0x1p20) {
    const double first = of_bits(bits_of(x) & ~int64_t{0x1FFFFFFF}), others = x - first;
    const Angle of_first = reduce_large(first);
    if (others == 0) return of_first;
    const Angle of_others = reduce(others);
    const Angle sum{of_first.quadrant + of_others.quadrant, of_first.rest + of_others.rest};
    if (size_of(sum.rest) <= kPi / 4) return {sum.quadrant & 3, sum.rest};
    const double way = with_sign_of(1, sum.rest);
    return {(sum.quadrant + static_cast<int>(way)) & 3, sum.rest - way * (kPi / 2)};
  }
  const int64_t k = nearest(x * kTwoOverPi);
  const double n = static_cast<double>(k);
  return {static_cast<int>(k & 3), x - n * 0x1.921FB544p0 - n * 0x1.0B4611A6p-34 - n * 0x1.3198A2E037073p-69};
}
/// |x| <= pi / 4: the series, whose next term is below 1e-13.
double small_sine(double x) {
  const double s = x * x;
  return x + x * s * polynomial(s, kSine);
}
double small_cosine(double x) {
  const double s = x * x;
  return 1 + s * polynomial(s, kCosine);
}
double sine_in(int quadrant, double x) {
  const double value = (quadrant & 1) != 0 ? small_cosine(x) : small_sine(x);
  return (quadrant & 2) != 0 ? -value : value;
}
double sine(double x) {
  if (x == 0) return x;
  const Angle a = reduce(x);
  return sine_in(a.quadrant, a.rest);
}
double cosine(double x) {
  const Angle a = reduce(x);
  return sine_in(a.quadrant + 1, a.rest);
}
double tangent(double x) {
  if (x == 0) return x;
  const Angle a = reduce(x);
  return sine_in(a.quadrant, a.rest) / sine_in(a.quadrant + 1, a.rest);
}

double arc_tangent(double x) {
  const double size = size_of(x);
  // Beyond tan(pi / 8) by the angles between it and pi / 4 or pi / 2.
  const double base = size > 2.414213562373095 ? kPi / 2 : size > 0.4142135623730950 ? kPi / 4 : 0;
  const double t = size > 2.414213562373095    ? -1 / size
                   : size > 0.4142135623730950 ? (size - 1) / (size + 1)
                                               : size;
  const double q = t * t;
  const double series = polynomial(q, kArcTangent);
  return with_sign_of(base + t * series, x);
}
double arc_tangent_of(double y, double x) {
  if (x == 0 && y == 0) return with_sign_of(with_sign_of(1, x) < 0 ? kPi : 0, y);
  if (size_of(x) > kLargestDouble && size_of(y) > kLargestDouble)
    return with_sign_of(x > 0 ? kPi / 4 : 3 * kPi / 4, y);
  if (size_of(y) > size_of(x)) return with_sign_of(kPi / 2, y) - arc_tangent(x / y);
  const double angle = arc_tangent(y / x);
  return x > 0 ? angle : angle + with_sign_of(kPi, y);
}
double arc_sine(double x) { return size_of(x) > 1 ? 0 : arc_tangent_of(x, root_of((1 - x) * (1 + x))); }
double arc_cosine(double x) { return size_of(x) > 1 ? 0 : arc_tangent_of(root_of((1 - x) * (1 + x)), x); }

// ---- hyperbolic functions

/// e^x / 2, which is a double for some x whose e^x is none.
double half_exponential(double x) {
  if (x < 709) return 0.5 * exponential(x);
  const double root = exponential(0.5 * x);
  return 0.5 * root * root;
}
double hyperbolic_sine(double x) {
  if (size_of(x) < 0.5) {  // where the difference of exponentials would lose digits
    const double s = x * x;
    return x + x * s * polynomial(s, kHyperbolicSine);
  }
  const double e = half_exponential(size_of(x));
  return with_sign_of(e - 0.25 / e, x);
}
double hyperbolic_cosine(double x) {
  const double e = half_exponential(size_of(x));
  return e + 0.25 / e;
}
double hyperbolic_tangent(double x) {
  return size_of(x) > 20 ? with_sign_of(1, x) : hyperbolic_sine(x) / hyperbolic_cosine(x);
}
double area_hyperbolic_sine(double x) {
  const double size = size_of(x);
  const double area = size > 0x1p30 ? natural_logarithm(size) + kLn2
                                    : logarithm_of_1_and(size + size * size / (1 + root_of(size * size + 1)));
  return with_sign_of(area, x);
}
double area_hyperbolic_cosine(double x) {
  if (!(x >= 1)) return 0;
  const double t = x - 1;
  return x > 0x1p30 ? natural_logarithm(x) + kLn2 : logarithm_of_1_and(t + root_of(2 * t + t * t));
}
double area_hyperbolic_tangent(double x) {
  if (size_of(x) >= 1) return size_of(x) == 1 ? with_sign_of(kLargest, x) : 0;
  return 0.5 * logarithm_of_1_and(2 * x / (1 - x));
}

double lesser(double x, double y) { return x < y ? x : y; }
double greater(double x, double y) { return x > y ? x : y; }
double positive_difference(double x, double y) { return x > y ? x - y : 0; }
double exponent_of(double x) {
  if (x == 0) return -kLargest;
  int exponent;
  parted(x, &exponent);
  return exponent - 1;
}

// ---- the error function and the gamma function

constexpr double kRootOfPi = 1.7724538509055160273, kLogarithmOfRootOfTwoPi = 0.91893853320467274178;

/// |x| < 2: x e^-x^2 (1 + 2x^2/3 (1 + 2x^2/5 (...))), whose terms are positive, so that nothing cancels.
double error_near_0(double x) {
  const double s = x * x;
  double sum = 1;
  for (int k = 40; k > 0; --k) sum = 1 + sum * (2 * s / (2 * k + 1));
  return 2 / kRootOfPi * x * exponential(-s) * sum;
}
/// 1 - erf x for x >= 2: Laplace's continued fraction. x^2 is exact before the exponential, which would enlarge its error.
double error_left_of(double x) {
  if (x > 27) return 0;
  const Pair square = product(x, x);
  double fraction = x;
  for (int k = 60; k > 0; --k) fraction = x + 0.5 * k / fraction;
  return exponential(-square.high) * (1 - square.low) / (kRootOfPi * fraction);
}
double error_function(double x) {
  const double size = size_of(x);
  return size < 2 ? error_near_0(x) : with_sign_of(1 - error_left_of(size), x);
}
double error_function_left(double x) {
  if (size_of(x) < 2) return 1 - error_near_0(x);
  return x < 0 ? 2 - error_left_of(-x) : error_left_of(x);
}

/// ln gamma(2 + z) = z (1 - Euler's constant + z (c2 + z (c3 + ...))), ck = (-1)^k (zeta(k) - 1) / k.
/// |z| <= 1/2 [DLMF 5.7.3] documented
constexpr double kOneLessEuler = 0.42278433509846714;
constexpr double kLogarithmOfGamma[] = {
    0.3224670334241132,     -0.0673523010531981,     0.020580808427784546,   -0.007385551028673986,
    0.0028905103307415234,  -0.001192753911703261,   0.0005096695247430425,  -0.00022315475845357939,
    9.945751278180853e-05,  -4.492623673813314e-05,  2.050721277567069e-05,  -9.439488275268397e-06,
    4.374866789907488e-06,  -2.039215753801366e-06,  9.55141213040742e-07,   -4.492469198764566e-07,
    2.1207184805554665e-07, -1.0043224823968099e-07, 4.7698101693639804e-08, -2.2711094608943164e-08,
    1.0838659214896955e-08, -5.183475041970047e-09,  2.4836745438024785e-09, -1.1921401405860912e-09};
double logarithm_of_gamma_near_2(double z) {
  return z * (kOneLessEuler + z * polynomial(z, kLogarithmOfGamma));
}

/// sin(pi x), whose zeros are exact.
double sine_of_half_turns(double x) {
  const double whole = rounded(x), value = sine(kPi * (x - whole));
  return remainder_towards_zero(whole, 2) != 0 ? -value : value;
}

/// Stirling's series, from 12 on. [DLMF 5.11.1] documented
constexpr double kStirling[] = {1.0 / 12, -1.0 / 360, 1.0 / 1260, -1.0 / 1680, 1.0 / 1188, -691.0 / 360360};
/// x > 0
double logarithm_of_gamma_above_0(double x) {
  if (x < 0.5) return logarithm_of_gamma_near_2(x) - logarithm_of_1_and(x) - natural_logarithm(x);
  if (x < 1.5) return logarithm_of_gamma_near_2(x - 1) - logarithm_of_1_and(x - 1);
  if (x >= 12) {
    const double reciprocal = 1 / x;
    return (x - 0.5) * natural_logarithm(x) - x +
           (kLogarithmOfRootOfTwoPi + reciprocal * polynomial(reciprocal * reciprocal, kStirling));
  }
  double factor = 1;
  while (x > 2.5) factor *= --x;
  return natural_logarithm(factor) + logarithm_of_gamma_near_2(x - 2);
}
double logarithm_of_gamma(double x) {
  if (size_of(x) > kLargestDouble) return HUGE_VAL;
  if (x > 0) return logarithm_of_gamma_above_0(x);
  if (truncated(x) == x) return HUGE_VAL;
  return natural_logarithm(kPi / size_of(sine_of_half_turns(x))) - logarithm_of_gamma_above_0(1 - x);
}

/// By products from where the series holds, which are exact for whole numbers up to 23. x > 0
double gamma_above_0(double x) {
  if (x > 171.7) return HUGE_VAL;
  double factor = 1;
  while (x < 1.5) factor /= x++;
  double from = x;
  while (from > 2.5) --from;
  double value = factor * exponential(logarithm_of_gamma_near_2(from - 2));
  for (; from < x - 0.5; ++from) value *= from;
  return value;
}
double gamma_function(double x) {
  if (x > 0) return gamma_above_0(x);
  if (x == 0) return with_sign_of(HUGE_VAL, x);
  return truncated(x) == x ? 0 : kPi / (sine_of_half_turns(x) * gamma_above_0(1 - x));
}
/// What remainder_to_nearest() leaves, and the last three bits of its quotient with their sign.
double remainder_and_quotient(double x, double y, int* quotient) {
  const double divisor = size_of(y), rest = remainder_to_nearest(x, y);
  *quotient = 0;
  if (!(divisor > 0 && divisor <= kLargestDouble && size_of(x) <= kLargestDouble)) return rest;
  // x less the multiples of 8 y, which leave no trace in those bits.
  const double left = divisor < 0x1p1020 ? remainder_towards_zero(size_of(x), 8 * divisor) : size_of(x);
  const int bits = static_cast<int>(nearest((left - with_sign_of(1, x) * rest) / divisor)) & 7;
  *quotient = (bits_of(x) < 0) != (bits_of(y) < 0) ? -bits : bits;
  return rest;
}

// ---- floats

/// What has the largest exponent is a number on an SPU, larger than any that is computed with here: the largest float stands for it.
double from_float(float x) {
  uint32_t bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  if ((bits & 0x7F800000) == 0x7F800000) return (bits >> 31) != 0 ? -kLargest : kLargest;
  return static_cast<double>(x);
}
float to_float(double x) {
  if (size_of(x) < kSmallest) {
    // What the rounding lifts to the smallest.
    if (size_of(x) < 0x1.FFFFFFp-127) return 0;
    return static_cast<float>(with_sign_of(kSmallest, x));
  }
  return static_cast<float>(x > kLargest ? kLargest : x < -kLargest ? -kLargest : x);
}

template <double (*kFunction)(double)>
inline double computed(double x) {
  const DoubleArithmetic rounding;
  return as_it_is_here(kFunction(as_it_is_here(x)));
}
template <double (*kFunction)(double, double)>
inline double computed(double x, double y) {
  const DoubleArithmetic rounding;
  return as_it_is_here(kFunction(as_it_is_here(x), as_it_is_here(y)));
}
template <double (*kFunction)(double)>
inline float computed(float x) {
  const DoubleArithmetic rounding;
  return as_it_is_here(to_float(kFunction(from_float(as_it_is_here(x)))));
}
template <double (*kFunction)(double, double)>
inline float computed(float x, float y) {
  const DoubleArithmetic rounding;
  return as_it_is_here(to_float(kFunction(from_float(as_it_is_here(x)), from_float(as_it_is_here(y)))));
}

}  // namespace

extern "C" {

// Floats of an SPU are always numbers. Doubles may be infinite, or NaN where an argument is NaN or a function has no value.
#define SC_NO_NUMBER __builtin_nan("")
#define SC_OF_1(name, function)                                           \
  double name(double x) { return is_nan(x) ? x : computed<function>(x); } \
  float name##f(float x) { return computed<function>(x); }
#define SC_OF_2(name, function)                                                                         \
  double name(double x, double y) { return is_nan(x) || is_nan(y) ? x + y : computed<function>(x, y); } \
  float name##f(float x, float y) { return computed<function>(x, y); }
#define SC_OF_1_WITHIN(name, function, outside)                                                   \
  double name(double x) { return is_nan(x) || (outside) ? SC_NO_NUMBER : computed<function>(x); } \
  float name##f(float x) { return computed<function>(x); }
#define SC_LOGARITHM(name, function, zero)                            \
  double name(double x) {                                             \
    if (!(x > (zero))) return x == (zero) ? -HUGE_VAL : SC_NO_NUMBER; \
    return computed<function>(x);                                     \
  }                                                                   \
  float name##f(float x) { return computed<function>(x); }
#define SC_OF_2_WITHIN(name, function, outside)                 \
  double name(double x, double y) {                             \
    if (is_nan(x) || is_nan(y)) return x + y;                   \
    return (outside) ? SC_NO_NUMBER : computed<function>(x, y); \
  }                                                             \
  float name##f(float x, float y) { return computed<function>(x, y); }
/// Of a number and NaN the number.
#define SC_OF_2_NUMBERS(name, function)                                                                \
  double name(double x, double y) { return is_nan(x) ? y : is_nan(y) ? x : computed<function>(x, y); } \
  float name##f(float x, float y) { return computed<function>(x, y); }
double sqrt(double x) {
  if (x == 0) return x;
  return !(x > 0) ? SC_NO_NUMBER : computed<root_of>(x);
}
float sqrtf(float x) { return computed<root_of>(x); }
SC_OF_1(cbrt, cube_root)
SC_OF_1(exp, exponential)
SC_OF_1(exp2, exponential_of_2)
SC_OF_1(expm1, exponential_less_1)
SC_LOGARITHM(log, natural_logarithm, 0)
SC_LOGARITHM(log2, logarithm_to_2, 0)
SC_LOGARITHM(log10, logarithm_to_10, 0)
SC_LOGARITHM(log1p, logarithm_of_1_and, -1)
double logb(double x) {
  if (x == 0) return -HUGE_VAL;
  return is_nan(x) || size_of(x) > kLargestDouble ? size_of(x) : computed<exponent_of>(x);
}
float logbf(float x) { return computed<exponent_of>(x); }
SC_OF_1_WITHIN(sin, sine, size_of(x) > kLargestDouble)
SC_OF_1_WITHIN(cos, cosine, size_of(x) > kLargestDouble)
SC_OF_1_WITHIN(tan, tangent, size_of(x) > kLargestDouble)
SC_OF_1_WITHIN(asin, arc_sine, size_of(x) > 1)
SC_OF_1_WITHIN(acos, arc_cosine, size_of(x) > 1)
SC_OF_1(atan, arc_tangent)
SC_OF_1(sinh, hyperbolic_sine)
SC_OF_1(cosh, hyperbolic_cosine)
SC_OF_1(tanh, hyperbolic_tangent)
SC_OF_1(asinh, area_hyperbolic_sine)
SC_OF_1_WITHIN(acosh, area_hyperbolic_cosine, x < 1)
double atanh(double x) {
  if (!(size_of(x) < 1)) return size_of(x) == 1 ? with_sign_of(HUGE_VAL, x) : SC_NO_NUMBER;
  return computed<area_hyperbolic_tangent>(x);
}
float atanhf(float x) { return computed<area_hyperbolic_tangent>(x); }
SC_OF_1(erf, error_function)
SC_OF_1(erfc, error_function_left)
SC_OF_1(lgamma, logarithm_of_gamma)
SC_OF_1_WITHIN(tgamma, gamma_function, x < 0 && truncated(x) == x)
SC_OF_1(floor, floor_of)
SC_OF_1(ceil, ceil_of)
SC_OF_1(trunc, truncated)
SC_OF_1(round, rounded)
SC_OF_1(rint, rounded_to_even)
SC_OF_1(nearbyint, rounded_to_even)
SC_OF_1(fabs, size_of)
double pow(double x, double y) {
  const bool has_value = x >= 0 || x < -kLargestDouble || is_nan(x) || is_nan(y) || truncated(y) == y;
  return has_value ? computed<power>(x, y) : SC_NO_NUMBER;
}
float powf(float x, float y) { return computed<power>(x, y); }
SC_OF_2(atan2, arc_tangent_of)
double hypot(double x, double y) {
  if (size_of(x) > kLargestDouble || size_of(y) > kLargestDouble) return HUGE_VAL;
  return is_nan(x) || is_nan(y) ? x + y : computed<hypotenuse>(x, y);
}
float hypotf(float x, float y) { return computed<hypotenuse>(x, y); }
SC_OF_2_WITHIN(fmod, remainder_towards_zero, y == 0 || size_of(x) > kLargestDouble)
SC_OF_2_WITHIN(remainder, remainder_to_nearest, y == 0 || size_of(x) > kLargestDouble)
SC_OF_2_NUMBERS(fmin, lesser)
SC_OF_2_NUMBERS(fmax, greater)
SC_OF_2(fdim, positive_difference)
double copysign(double x, double y) { return with_sign_of(x, y); }
float copysignf(float x, float y) { return computed<with_sign_of>(x, y); }

double remquo(double x, double y, int* quotient) {
  const DoubleArithmetic rounding;
  const double rest = as_it_is_here(remainder_and_quotient(as_it_is_here(x), as_it_is_here(y), quotient));
  if (is_nan(x) || is_nan(y)) return x + y;
  return y == 0 || size_of(x) > kLargestDouble ? SC_NO_NUMBER : rest;
}
float remquof(float x, float y, int* quotient) {
  const DoubleArithmetic rounding;
  return as_it_is_here(
      to_float(remainder_and_quotient(from_float(as_it_is_here(x)), from_float(y), quotient)));
}

double ldexp(double x, int exponent) {
  const DoubleArithmetic rounding;
  return as_it_is_here(scaled(as_it_is_here(x), exponent));
}
float ldexpf(float x, int exponent) {
  const DoubleArithmetic rounding;
  return as_it_is_here(to_float(scaled(from_float(as_it_is_here(x)), exponent)));
}
double scalbn(double x, int exponent) { return ldexp(x, exponent); }
float scalbnf(float x, int exponent) { return ldexpf(x, exponent); }
double scalbln(double x, long exponent) { return ldexp(x, static_cast<int>(exponent)); }
float scalblnf(float x, long exponent) { return ldexpf(x, static_cast<int>(exponent)); }
double frexp(double x, int* exponent) { return parted(x, exponent); }
float frexpf(float x, int* exponent) { return static_cast<float>(parted(from_float(x), exponent)); }
int ilogb(double x) { return x == 0 ? FP_ILOGB0 : static_cast<int>(logb(x)); }
int ilogbf(float x) { return x == 0 ? FP_ILOGB0 : static_cast<int>(logbf(x)); }
double modf(double x, double* whole) {
  *whole = trunc(x);
  return copysign(x - *whole, x);
}
float modff(float x, float* whole) {
  *whole = truncf(x);
  return copysignf(x - *whole, x);
}
float fmaf(float x, float y, float z) {
  const DoubleArithmetic rounding;
  return as_it_is_here(to_float(from_float(as_it_is_here(x)) * from_float(y) + from_float(as_it_is_here(z))));
}

/// Rounded once.
double fma(double x, double y, double z) {
  const DoubleArithmetic rounding;
#ifndef __x86_64__
  return spu_extract(spu_madd(spu_promote(x, 0), spu_promote(y, 0), spu_promote(z, 0)), 0);
#else
  const __m128d sum = _mm_fmadd_sd(_mm_set_sd(as_it_is_here(x)), _mm_set_sd(y), _mm_set_sd(z));
  return as_it_is_here(_mm_cvtsd_f64(sum));
#endif
}

double nextafter(double x, double y) {
  if (is_nan(x) || is_nan(y)) return x + y;
  const int64_t from = place_of(x), to = place_of(y);
  if (from == to) return y;
  const double next = at_place(from < to ? from + 1 : from - 1);
  return next == 0 ? with_sign_of(next, x) : next;
}
float nextafterf(float x, float y) {
  const int32_t from = place_of(x), to = place_of(y);
  if (from == to) return y;
  return float_at_place(from < to ? from + 1 : from - 1);
}

#define SC_TO_INTEGER(type, name, function)                      \
  type name(double x) { return static_cast<type>(function(x)); } \
  type name##f(float x) { return static_cast<type>(function##f(x)); }
SC_TO_INTEGER(long, lrint, rint)
SC_TO_INTEGER(long long, llrint, rint)
SC_TO_INTEGER(long, lround, round)
SC_TO_INTEGER(long long, llround, round)

}  // extern "C"
