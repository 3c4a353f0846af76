// Conversions between integers and floats, for all 128 scales.
#include <cmath>
#include <string>
#include <utility>

#include "intrinsics_support.h"

namespace softcell::test {
namespace {

class IntrinsicsConvert : public SpuArithmetic {};

/// value / 2^scale: the integer is exact in a double, whose low bits are cut off.
std::uint32_t float_of_integer(double value, int scale) {
  if (value == 0.0) return 0;
  const std::uint64_t bits = bits_of(std::ldexp(value, -scale));
  const int exponent = static_cast<int>(bits >> 52 & 0x7FF) - 1023 + 127;
  if (exponent <= 0) return 0;
  return static_cast<std::uint32_t>(bits >> 32 & 0x80000000) | static_cast<std::uint32_t>(exponent) << 23 |
         static_cast<std::uint32_t>(bits >> 29 & 0x7FFFFF);
}

/// value * 2^scale of SPU bits, truncated; at most 2^24 * 2^105 * 2^127, exact in a double.
double scaled(std::uint32_t bits, int scale) {
  const int exponent = static_cast<int>(bits >> 23 & 0xFF);
  if (exponent == 0) return 0.0;
  const double magnitude =
      std::trunc(std::ldexp(static_cast<double>((bits & 0x7FFFFF) | 0x800000), exponent - 150 + scale));
  return (bits & 0x80000000) != 0 ? -magnitude : magnitude;
}
int clamped(double value) {
  return value >= 2147483648.0 ? INT32_MAX : value < -2147483648.0 ? INT32_MIN : static_cast<int>(value);
}
unsigned int clamped_unsigned(double value) {
  return value >= 4294967296.0 ? UINT32_MAX
         : value <= 0.0        ? 0
                               : static_cast<unsigned int>(static_cast<std::uint64_t>(value));
}

/// Integers with their leading one anywhere.
template <class V>
V integers(Operands& operands) {
  LanesOf<V> result;
  for (auto& lane : result) {
    lane = operands.lane<typename V::Lane>();
    if (operands.count(0, 1) == 0)
      lane = static_cast<typename V::Lane>(bits_of(lane) >> operands.count(0, 31));
  }
  return vector_of<V>(result);
}

/// Floats that come out near the clamps, small, or anywhere.
vec_float4 floats(Operands& operands, int scale) {
  LanesOf<vec_uint4> result;
  for (auto& lane : result) {
    lane = operands.lane<unsigned int>();
    const int exponent = 127 - scale + operands.count(-2, 33);
    if (operands.count(0, 3) != 0 && exponent > 0)
      lane = (lane & 0x807FFFFF) | static_cast<std::uint32_t>(exponent) << 23;
  }
  return vec_float4(vector_of<vec_uint4>(result));
}

template <int Scale>
void check_scale() {
  Operands operands(50 + Scale);
  for (int round = 0; round < 200 && !::testing::Test::HasFatalFailure(); ++round) {
    const vec_int4 s = integers<vec_int4>(operands);
    const vec_uint4 u = integers<vec_uint4>(operands);
    const vec_float4 f = floats(operands, Scale);
    LanesOf<vec_uint4> from_signed, from_unsigned, to_unsigned;
    LanesOf<vec_int4> to_signed;
    for (std::size_t i = 0; i < 4; ++i) {
      from_signed[i] = float_of_integer(lanes(s)[i], Scale);
      from_unsigned[i] = float_of_integer(lanes(u)[i], Scale);
      const double value = scaled(bits_of(lanes(f)[i]), Scale);
      to_signed[i] = clamped(value);
      to_unsigned[i] = clamped_unsigned(value);
    }
    const std::string by = " by 2^" + std::to_string(Scale);
    expect_lanes(vec_uint4(spu_convtf(s, Scale)), from_signed, "spu_convtf of signed words" + by);
    expect_lanes(vec_uint4(spu_convtf(u, Scale)), from_unsigned, "spu_convtf of unsigned words" + by);
    expect_lanes(spu_convts(f, Scale), to_signed, "spu_convts" + by);
    expect_lanes(spu_convtu(f, Scale), to_unsigned, "spu_convtu" + by);
  }
}

template <int... Scale>
void check_scales(std::integer_sequence<int, Scale...>) {
  (check_scale<Scale>(), ...);
}

TEST_F(IntrinsicsConvert, EveryScaleTruncatesAndClamps) {
  check_scales(std::make_integer_sequence<int, 128>{});
}

TEST_F(IntrinsicsConvert, NoRoundingModeEnters) {
  for (const unsigned int rounding : {_MM_ROUND_NEAREST, _MM_ROUND_UP, _MM_ROUND_DOWN}) {
    const unsigned int mode = _mm_getcsr();
    _mm_setcsr(_MM_MASK_MASK | rounding);
    check_scale<0>();
    check_scale<100>();
    _mm_setcsr(mode);
  }
}

TEST_F(IntrinsicsConvert, ConstantsAreConvertedAsIfAtRunTime) {
  EXPECT_EQ(bits_of(spu_extract(spu_convtf(spu_splats(0x7FFFFFFF), 0), 0)), 0x4EFFFFFFu)
      << "nearest would give 2^31";
  EXPECT_EQ(bits_of(spu_extract(spu_convtf(spu_splats(INT32_MIN), 0), 0)), 0xCF000000u);
  EXPECT_EQ(bits_of(spu_extract(spu_convtf(spu_splats(0xFFFFFFFFu), 0), 0)), 0x4F7FFFFFu);
  EXPECT_EQ(bits_of(spu_extract(spu_convtf(spu_splats(-1), 127), 0)), 0u) << "below the smallest float: +0";
  EXPECT_EQ(bits_of(spu_extract(spu_convtf(spu_splats(3u), 127), 0)), 0x00C00000u);
  EXPECT_EQ(spu_extract(spu_convts(spu_splats(-3.99f), 0), 0), -3);
  EXPECT_EQ(spu_extract(spu_convts(vec_float4(spu_splats(0x7FFFFFFFu)), 0), 0), INT32_MAX)
      << "no NaN, but 2^129 less a bit";
  EXPECT_EQ(spu_extract(spu_convts(vec_float4(spu_splats(0xFF800000u)), 0), 0), INT32_MIN);
  EXPECT_EQ(spu_extract(spu_convtu(spu_splats(0x1.fffffep31f), 0), 0), 0xFFFFFF00u);
  EXPECT_EQ(spu_extract(spu_convtu(spu_splats(-1.0f), 0), 0), 0u);
}

}  // namespace
}  // namespace softcell::test
