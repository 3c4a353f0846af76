#pragma once
// Sine, cosine and exponential with the same bits on every host.
//
// The C library's versions differ in the last bit from one library and processor to the next. All code whose results reach simulation state
// or a golden picture uses these functions instead. They consist of additions and multiplications, each rounded once (the project compiles
// with -ffp-contract=off). std::sqrt is exact everywhere and needs no replacement.

#include <bit>
#include <cstdint>
#include <limits>

namespace softcell::ppu {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kMaxSineError = 1e-15;         ///< absolute, for |angle| <= kMaxSineAngle
inline constexpr double kMaxSineAngle = 1e6;           ///< radians
inline constexpr double kMaxExponentialError = 1e-15;  ///< relative

namespace detail {

constexpr double nearest_integer(double x) {
  return static_cast<double>(static_cast<std::int64_t>(x < 0 ? x - 0.5 : x + 0.5));
}

/// sum_k first * (-square)^k / ((n+1)(n+2) ... (n+2k)): the Taylor series of sine (n = 1) and cosine (n = 0),
/// by Horner's rule.
constexpr double alternating_series(double first, double square, int n) {
  double sum = 1.0;
  for (int k = n + 18; k > n; k -= 2)
    sum = 1.0 - square * sum / (k * (k - 1));  // next term past pi/4: < 1e-20
  return first * sum;
}

/// sin(angle + quarter_turns * pi/2).
constexpr double sine_of_quadrant(double angle, std::int64_t quarter_turns) {
  // pi/2 in three parts, the first two of 33 bits: their products with a quadrant number below 2^20 are
  // exact.
  constexpr double kHigh = 0x1.921fb544p+0, kMiddle = 0x1.0b4611a6p-34, kLow = 0x1.3198a2e037073p-69;
  const double quadrant = nearest_integer(angle * (2.0 / kPi));
  const double rest = ((angle - quadrant * kHigh) - quadrant * kMiddle) - quadrant * kLow;
  const auto turn = static_cast<std::uint64_t>(static_cast<std::int64_t>(quadrant) + quarter_turns) & 3u;
  const double value =
      (turn & 1u) ? alternating_series(1.0, rest * rest, 0) : alternating_series(rest, rest * rest, 1);
  return (turn & 2u) ? -value : value;
}

}  // namespace detail

/// Sine of an angle in radians. Error below kMaxSineError for |angle| <= kMaxSineAngle; beyond it, and for
/// NaN, NaN.
constexpr double sine(double angle) {
  if (!(angle >= -kMaxSineAngle && angle <= kMaxSineAngle)) return std::numeric_limits<double>::quiet_NaN();
  return detail::sine_of_quadrant(angle, 0);
}

/// Cosine, with the range and error of sine().
constexpr double cosine(double angle) {
  if (!(angle >= -kMaxSineAngle && angle <= kMaxSineAngle)) return std::numeric_limits<double>::quiet_NaN();
  return detail::sine_of_quadrant(angle, 1);
}

/// e to the power of x. Relative error below kMaxExponentialError for x in [-708, 709]; 0 below, infinity
/// above, NaN for NaN.
constexpr double exponential(double x) {
  if (x != x) return x;
  if (x < -708.0) return 0.0;
  if (x > 709.0) return std::numeric_limits<double>::infinity();
  // x = power * ln 2 + rest with |rest| <= 0.35; ln 2 in two parts, the first of 33 bits, so that its product
  // is exact.
  constexpr double kLn2High = 0x1.62e42feep-1, kLn2Low = 0x1.a39ef35793c76p-33, kLog2E = 0x1.71547652b82fep+0;
  const double power = detail::nearest_integer(x * kLog2E);
  const double rest = (x - power * kLn2High) - power * kLn2Low;
  double sum = 1.0;
  for (int k = 15; k > 0; --k) sum = 1.0 + rest * sum / k;  // next term: < 1e-21
  // power is in -1021..1023: 2^power is a normal double.
  return sum *
         std::bit_cast<double>((static_cast<std::uint64_t>(static_cast<std::int64_t>(power) + 1023)) << 52);
}

}  // namespace softcell::ppu
