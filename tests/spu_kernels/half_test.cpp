// The kernels' conversion from float to half, against a definition in exact arithmetic: the nearest half, the
// larger in magnitude of two.

#include "common/half.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include "spu_kernels/intrinsics_support.h"

namespace softcell::spu {
namespace {

class KernelHalf : public test::SpuArithmetic {};

std::uint32_t bits_of(float f) {
  std::uint32_t bits;
  std::memcpy(&bits, &f, sizeof bits);
  return bits;
}

float float_of(std::uint32_t bits) {
  float f;
  std::memcpy(&f, &bits, sizeof f);
  return f;
}

/// The value of a half from its fields; exact.
double value_of_half(std::uint16_t half) {
  const int exponent = half >> 10 & 31, fraction = half & 1023;
  const double magnitude =
      exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return (half & 0x8000) != 0 ? -magnitude : magnitude;
}

/// The definition: among all halves the nearest to the float, at a tie the larger in magnitude; from
/// 65520 on infinity.
std::uint16_t nearest_half(float f) {
  const auto sign = static_cast<std::uint16_t>(bits_of(f) >> 16 & 0x8000);
  const double magnitude = std::fabs(static_cast<double>(f));
  if (magnitude >= 65520) return static_cast<std::uint16_t>(sign | 0x7C00);
  int low = 0, high = 0x7BFF;  // bracket by bisection: value_of_half grows with the bits
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (value_of_half(static_cast<std::uint16_t>(middle)) <= magnitude) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  const double below = value_of_half(static_cast<std::uint16_t>(low));
  const double above = low == 0x7BFF ? 65536 : value_of_half(static_cast<std::uint16_t>(low + 1));
  const double to_below = magnitude - below, to_above = above - magnitude;
  const bool up = to_above <= to_below;
  return static_cast<std::uint16_t>(sign | (low + (up ? 1 : 0)));
}

std::uint16_t kernel_half(float f) {
  return static_cast<std::uint16_t>(spu_extract(high_half_of_any(spu_splats(f)), 2) >> 16);
}

bool is_normal(float f) { return std::fabs(f) >= 0x1p-14f && std::fabs(f) < 65520.0f; }

void expect_nearest(float f) {
  ASSERT_EQ(kernel_half(f), nearest_half(f)) << f << " = " << std::hex << bits_of(f);
  if (is_normal(f)) {
    ASSERT_EQ(spu_extract(high_half_or_zero(spu_splats(f)), 1) >> 16, nearest_half(f))
        << f << " = " << std::hex << bits_of(f);
  }
  if (is_normal(f) && f > 0) {
    ASSERT_EQ(spu_extract(high_half_of_positive(spu_splats(f)), 3) >> 16, nearest_half(f))
        << f << " = " << std::hex << bits_of(f);
  }
}

TEST_F(KernelHalf, KeepsEveryHalf) {
  for (std::uint32_t half = 0; half <= 0xFFFF; ++half) {
    if ((half & 0x7C00) == 0x7C00) continue;  // infinities and NaNs: below
    ASSERT_EQ(kernel_half(static_cast<float>(value_of_half(static_cast<std::uint16_t>(half)))), half);
  }
}

TEST_F(KernelHalf, KeepsInfinitiesAndNansAsTheyAre) {
  EXPECT_EQ(kernel_half(float_of(0x7F800000)), 0x7C00);
  EXPECT_EQ(kernel_half(float_of(0xFF800000)), 0xFC00);
  for (std::uint32_t payload = 1; payload < 1024; ++payload) {
    const std::uint16_t half = kernel_half(float_of(0x7F800000 | payload << 13));
    ASSERT_EQ(half, 0x7C00 | payload);
    ASSERT_EQ(kernel_half(float_of(0xFF800000 | payload << 13)), 0xFC00 | payload);
  }
  EXPECT_EQ(kernel_half(float_of(0x7F800001)), 0x7E00) << "a payload that does not fit still is a NaN";
}

TEST_F(KernelHalf, RoundsToTheNearestAtAndAroundEveryMiddle) {
  for (std::uint32_t half = 0; half < 0x7BFF; ++half) {
    const double a = value_of_half(static_cast<std::uint16_t>(half)),
                 b = value_of_half(static_cast<std::uint16_t>(half + 1));
    const auto middle = static_cast<float>((a + b) / 2);  // exact: a float has the bits
    expect_nearest(middle);
    expect_nearest(-middle);
    expect_nearest(std::nextafterf(middle, 0.0f));
    expect_nearest(std::nextafterf(middle, 1e9f));
  }
}

TEST_F(KernelHalf, OverflowsWhereRoundingDoes) {
  EXPECT_EQ(kernel_half(65519.996f), 0x7BFF);
  EXPECT_EQ(kernel_half(65520.0f), 0x7C00);
  EXPECT_EQ(kernel_half(-1e30f), 0xFC00);
  EXPECT_EQ(kernel_half(0x1p-25f), 1) << "a tie with zero";
  EXPECT_EQ(kernel_half(std::nextafterf(0x1p-25f, 0.0f)), 0);
  EXPECT_EQ(kernel_half(float_of(1)), 0);
  EXPECT_EQ(kernel_half(-0.0f), 0x8000);
}

TEST_F(KernelHalf, MakesZeroOfWhatIsTooSmallForANormalHalf) {
  for (const float f : {std::nextafterf(0x1p-14f, 0.0f), 0x1p-15f, 1e-30f, 0.0f}) {
    EXPECT_EQ(spu_extract(high_half_or_zero(spu_splats(f)), 0) >> 16, 0u) << f;
    EXPECT_EQ(spu_extract(high_half_or_zero(spu_splats(-f)), 0) >> 16, 0u) << "no sign";
  }
}

TEST_F(KernelHalf, AgreesWithTheDefinitionOnRandomBits) {
  std::mt19937 random(1);
  for (int i = 0; i < 200'000; ++i) {
    const std::uint32_t bits = static_cast<std::uint32_t>(random());
    if ((bits & 0x7F800000) != 0x7F800000) expect_nearest(float_of(bits));
    // And where halves live: exponents 2^-30 to 2^17.
    const std::uint32_t exponent = 97 + bits % 48;
    expect_nearest(float_of((bits & 0x807FFFFF) | exponent << 23));
  }
}

}  // namespace
}  // namespace softcell::spu
