#include "ppu/numbers/half.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "support/float_from_half.h"

namespace softcell::ppu {
namespace {

bool is_nan(std::uint16_t half) { return (half & 0x7FFFu) > 0x7C00u; }

TEST(Half, AllValuesSurviveTheWayToFloatAndBack) {
  for (std::uint32_t bits = 0; bits < 65536; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    const float value = float_from_half(half);
    // A NaN comes back quiet, with its payload.
    const std::uint32_t expected = is_nan(half) ? bits | 0x200u : bits;
    ASSERT_EQ(half_from_float(value), expected) << std::hex << bits;
    ASSERT_EQ(std::isnan(value), is_nan(half)) << std::hex << bits;
  }
}

// The definition: (-1)^s 2^(e-15) (1 + f/1024), or (-1)^s 2^-14 f/1024 for e = 0.
TEST(Half, MeansWhatTheStandardSays) {
  for (std::uint32_t bits = 0; bits < 0x7C00u; ++bits) {
    const int exponent = static_cast<int>(bits >> 10);
    const double fraction = (bits & 0x3FFu) / 1024.0;
    const double expected =
        exponent == 0 ? std::ldexp(fraction, -14) : std::ldexp(1 + fraction, exponent - 15);
    ASSERT_EQ(static_cast<double>(float_from_half(static_cast<std::uint16_t>(bits))), expected)
        << std::hex << bits;
    ASSERT_EQ(static_cast<double>(float_from_half(static_cast<std::uint16_t>(bits | 0x8000u))), -expected);
  }
}

// Between two neighbours: below the middle rounds down, above it up, the middle itself to the even one.
TEST(Half, RoundsToNearestTiesToEvenBetweenAllNeighbours) {
  for (std::uint32_t bits = 0; bits < 0x7BFFu; ++bits) {
    const float low = float_from_half(static_cast<std::uint16_t>(bits));
    const float high = float_from_half(static_cast<std::uint16_t>(bits + 1));
    const float middle = 0.5f * (low + high);  // exact: a float has 13 bits more
    const std::uint32_t even = bits % 2 == 0 ? bits : bits + 1;
    ASSERT_EQ(half_from_float(middle), even) << std::hex << bits;
    ASSERT_EQ(half_from_float(std::nextafter(middle, -1.0f)), bits) << std::hex << bits;
    ASSERT_EQ(half_from_float(std::nextafter(middle, 1e9f)), bits + 1) << std::hex << bits;
    ASSERT_EQ(half_from_float(-middle), even | 0x8000u) << std::hex << bits;
  }
}

TEST(Half, AtItsEnds) {
  EXPECT_EQ(half_from_float(65504.0f), 0x7BFFu);
  EXPECT_EQ(half_from_float(std::nextafter(65520.0f, 0.0f)), 0x7BFFu);
  EXPECT_EQ(half_from_float(65504.0f + 16.0f), 0x7C00u);
  EXPECT_EQ(half_from_float(INFINITY), 0x7C00u);
  EXPECT_EQ(half_from_float(-INFINITY), 0xFC00u);
  EXPECT_EQ(half_from_float(0x1p-25f), 0u);
  EXPECT_EQ(half_from_float(std::nextafter(0x1p-25f, 1.0f)), 1u);
  EXPECT_EQ(half_from_float(0x1p-149f), 0u);
  EXPECT_EQ(half_from_float(-0.0f), 0x8000u);
  EXPECT_TRUE(
      is_nan(half_from_float(std::bit_cast<float>(0x7F800001u))));  // payload only in bits that are dropped
  EXPECT_EQ(half_from_float(std::bit_cast<float>(0xFFC02000u)), 0xFE01u);
}

}  // namespace
}  // namespace softcell::ppu
