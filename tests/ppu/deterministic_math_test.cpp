#include "ppu/numbers/deterministic_math.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace softcell::ppu {
namespace {

TEST(DeterministicMath, SineAndCosineKeepTheirStatedError) {
  double worst_sine = 0, worst_cosine = 0, at_sine = 0, at_cosine = 0;
  const auto check = [&](double angle) {
    const double s = std::abs(static_cast<double>(std::sin(static_cast<long double>(angle)) - sine(angle)));
    const double c = std::abs(static_cast<double>(std::cos(static_cast<long double>(angle)) - cosine(angle)));
    if (s > worst_sine) worst_sine = s, at_sine = angle;
    if (c > worst_cosine) worst_cosine = c, at_cosine = angle;
  };
  for (int i = -200000; i <= 200000; ++i) {
    check(i * 5e-5);                      // around 0, finely
    check(i * (kMaxSineAngle / 200000));  // the whole range
    check(i * (kPi / 4));                 // where the reduction changes its mind, and multiples of pi/2
  }
  EXPECT_LT(worst_sine, kMaxSineError) << "at " << at_sine;
  EXPECT_LT(worst_cosine, kMaxSineError) << "at " << at_cosine;
}

TEST(DeterministicMath, SineRefusesAnglesItCannotReduce) {
  EXPECT_TRUE(std::isnan(sine(kMaxSineAngle * 1.001)));
  EXPECT_TRUE(std::isnan(cosine(-kMaxSineAngle * 1.001)));
  EXPECT_TRUE(std::isnan(sine(INFINITY)));
  EXPECT_TRUE(std::isnan(cosine(NAN)));
}

TEST(DeterministicMath, ExponentialKeepsItsStatedError) {
  double worst = 0, at = 0;
  for (int i = -708000; i <= 709000; ++i) {
    const double x = i * 1e-3;
    const long double exact = std::exp(static_cast<long double>(x));
    const double error = std::abs(static_cast<double>((exponential(x) - exact) / exact));
    if (error > worst) worst = error, at = x;
  }
  EXPECT_LT(worst, kMaxExponentialError) << "at " << at;
}

TEST(DeterministicMath, ExponentialAtItsEnds) {
  EXPECT_EQ(exponential(0), 1.0);
  EXPECT_EQ(exponential(-708.5), 0.0);
  EXPECT_EQ(exponential(-INFINITY), 0.0);
  EXPECT_EQ(exponential(709.5), INFINITY);
  EXPECT_TRUE(std::isnan(exponential(NAN)));
}

// Bits written down once: every compiler and every optimisation must make the same ones.
TEST(DeterministicMath, HasTheSameBitsEverywhere) {
  std::uint64_t sum = 0;
  for (int i = -100000; i <= 100000; ++i) {
    const double x = i * 0.00706;
    for (const double value : {sine(x), cosine(x), exponential(x)})
      sum = sum * 31 + std::bit_cast<std::uint64_t>(value);
  }
  EXPECT_EQ(sum, 14621454030132895366u);
}

}  // namespace
}  // namespace softcell::ppu
