// Single precision against the SPU's own rules: arithmetic by exact doubles, compares as sign and magnitude.
#include <cmath>
#include <string>
#include <vector>

#include "intrinsics_support.h"

namespace softcell::test {
namespace {

class IntrinsicsSingle : public SpuArithmetic {};

/// The value of SPU bits: denormals are zero, an exponent of 255 is one like any other. [SPU-ISA] documented
double value_of(std::uint32_t bits) {
  const int exponent = static_cast<int>(bits >> 23 & 0xFF);
  if (exponent == 0) return 0.0;
  const double magnitude = std::ldexp(static_cast<double>((bits & 0x7FFFFF) | 0x800000), exponent - 150);
  return (bits & 0x80000000) != 0 ? -magnitude : magnitude;
}

/// Truncated to a float's 24 bits and saturated; zero is positive. The double must itself be exact or
/// truncated.
std::uint32_t truncated(double exact) {
  const std::uint64_t bits = bits_of(exact);
  const auto sign = static_cast<std::uint32_t>(bits >> 32 & 0x80000000);
  const int exponent = static_cast<int>(bits >> 52 & 0x7FF) - 1023;
  if (exact == 0.0 || exponent < -126) return 0;
  if (exponent > 128) return sign | 0x7FFFFFFF;
  return sign | static_cast<std::uint32_t>(exponent + 127) << 23 |
         static_cast<std::uint32_t>(bits >> 29 & 0x7FFFFF);
}

// Products of two floats are exact in a double; a sum of one with a float truncates here, in the mode the
// fixture sets, and truncating twice is truncating once.
using Model = double (*)(double, double, double);

struct Operation {
  const char* name;
  vec_float4 (*intrinsic)(vec_float4, vec_float4, vec_float4);
  Model model;
};
const Operation kOperations[] = {
    {"spu_add", [](vec_float4 a, vec_float4 b, vec_float4) { return spu_add(a, b); },
     [](double a, double b, double) { return a + b; }},
    {"spu_sub", [](vec_float4 a, vec_float4 b, vec_float4) { return spu_sub(a, b); },
     [](double a, double b, double) { return a - b; }},
    {"spu_mul", [](vec_float4 a, vec_float4 b, vec_float4) { return spu_mul(a, b); },
     [](double a, double b, double) { return a * b; }},
    {"spu_madd", [](vec_float4 a, vec_float4 b, vec_float4 c) { return spu_madd(a, b, c); },
     [](double a, double b, double c) { return a * b + c; }},
    {"spu_msub", [](vec_float4 a, vec_float4 b, vec_float4 c) { return spu_msub(a, b, c); },
     [](double a, double b, double c) { return a * b - c; }},
    {"spu_nmsub", [](vec_float4 a, vec_float4 b, vec_float4 c) { return spu_nmsub(a, b, c); },
     [](double a, double b, double c) { return c - a * b; }},
};

/// Floats whose products and sums often cancel, overlap partly, or leave only a sticky bit; zeros and
/// denormals of both signs.
std::uint32_t operand(Operands& operands) {
  const auto random = static_cast<std::uint32_t>(operands.bits());
  std::uint32_t exponent;
  switch (operands.count(0, 7)) {
    case 0:
      return random & 0x80000000;
    case 1:
      return random & 0x807FFFFF;  // denormal
    case 2:
      exponent = static_cast<std::uint32_t>(operands.count(1, 254));
      break;
    case 3:
      exponent = static_cast<std::uint32_t>(operands.count(60, 70));
      break;  // products near the smallest
    default:
      exponent = static_cast<std::uint32_t>(operands.count(100, 150));
      break;
  }
  const std::uint32_t fraction = operands.count(0, 3) == 0 ? (random & 1) * 0x7FFFFF : random & 0x7FFFFF;
  return (random & 0x80000000) | exponent << 23 | fraction;
}

TEST_F(IntrinsicsSingle, ArithmeticTruncatesTheExactResult) {
  for (const Operation& operation : kOperations) {
    Operands operands(40);
    int compared = 0;
    for (int round = 0; round < 20000; ++round) {
      LanesOf<vec_uint4> a, b, c;
      for (std::size_t i = 0; i < 4; ++i)
        a[i] = operand(operands), b[i] = operand(operands), c[i] = operand(operands);
      if (round % 4 == 0) b[0] = a[0] ^ 0x80000000, c[1] = a[1];  // cancel
      const auto got = lanes(vec_uint4(operation.intrinsic(vec_float4(vector_of<vec_uint4>(a)),
                                                           vec_float4(vector_of<vec_uint4>(b)),
                                                           vec_float4(vector_of<vec_uint4>(c)))));
      for (std::size_t i = 0; i < 4; ++i) {
        const std::uint32_t expected =
            truncated(operation.model(value_of(a[i]), value_of(b[i]), value_of(c[i])));
        if ((expected >> 23 & 0xFF) == 255) continue;  // beyond what the host's format holds
        // The sign of a zero is right for exact products only.
        const double product = value_of(a[i]) * value_of(b[i]);
        const bool any_zero = expected == 0 && !(operation.name == std::string("spu_mul") && product == 0.0);
        ASSERT_EQ(any_zero ? got[i] & 0x7FFFFFFF : got[i], expected)
            << std::hex << operation.name << " of " << a[i] << ", " << b[i] << ", " << c[i];
        ++compared;
      }
    }
    EXPECT_GT(compared, 70000) << operation.name;
  }
}

float at(vec_float4 v) { return spu_extract(v, 0); }
std::uint32_t bits_at(vec_float4 v) { return bits_of(spu_extract(v, 0)); }

TEST_F(IntrinsicsSingle, AStickyBitReachesTheTruncation) {
  // Constants that the compiler could compute with before the program runs, in the wrong mode.
  EXPECT_EQ(bits_at(spu_sub(spu_splats(1.0f), spu_splats(0x1p-60f))), 0x3F7FFFFFu);
  EXPECT_EQ(bits_at(spu_nmsub(spu_splats(0x1p-60f), spu_splats(0x1p-60f), spu_splats(1.0f))), 0x3F7FFFFFu);
  EXPECT_EQ(bits_at(spu_add(spu_splats(1.0f), spu_splats(0x1.8p-24f))), 0x3F800000u)
      << "nearest would round up";
  EXPECT_EQ(bits_at(spu_mul(spu_splats(0x1.fffffep0f), spu_splats(0x1.fffffep0f))), 0x407FFFFEu);
  EXPECT_EQ(
      bits_at(spu_msub(spu_splats(0x1.000002p0f), spu_splats(0x1.000002p0f), spu_splats(0x1.000004p0f))),
      0x28800000u)
      << "rounded once";
}

TEST_F(IntrinsicsSingle, ZeroProductsArePositive) {
  EXPECT_EQ(bits_at(spu_mul(spu_splats(-0.0f), spu_splats(3.0f))), 0u);
  EXPECT_EQ(bits_at(spu_mul(spu_splats(0.0f), spu_splats(-3.0f))), 0u);
  EXPECT_EQ(bits_at(spu_sub(spu_splats(3.0f), spu_splats(3.0f))), 0u);
  EXPECT_EQ(at(spu_mul(spu_splats(0x1p-100f), spu_splats(0x1p-100f))), 0.0f);
}

// ---- compares: every class of operand, the extended binade included

/// Sign and magnitude as an integer, denormals as zero.
std::int64_t order(std::uint32_t bits) {
  const std::int64_t magnitude = bits & 0x7FFFFFFF;
  if (magnitude < 0x00800000) return 0;
  return (bits & 0x80000000) != 0 ? -magnitude : magnitude;
}

TEST_F(IntrinsicsSingle, ComparesTakeEveryBitPattern) {
  const std::uint32_t edges[] = {0x00000000, 0x80000000, 0x00000001, 0x807FFFFF, 0x00800000, 0x80800000,
                                 0x3F800000, 0xBF800000, 0x3F800001, 0x7F7FFFFF, 0x7F800000, 0xFF800000,
                                 0x7F800001, 0x7FFFFFFF, 0xFFFFFFFF, 0xFFC00000};
  Operands operands(41);
  std::vector<std::uint32_t> values(std::begin(edges), std::end(edges));
  for (int i = 0; i < 100; ++i) values.push_back(static_cast<std::uint32_t>(operands.bits()));
  for (const std::uint32_t a : values) {
    for (const std::uint32_t b : values) {
      const vec_float4 x(spu_splats(a)), y(spu_splats(b));
      const std::int64_t m = std::abs(order(a)), n = std::abs(order(b));
      ASSERT_EQ(spu_extract(spu_cmpeq(x, y), 1), order(a) == order(b) ? ~0u : 0u)
          << std::hex << a << " == " << b;
      ASSERT_EQ(spu_extract(spu_cmpgt(x, y), 1), order(a) > order(b) ? ~0u : 0u)
          << std::hex << a << " > " << b;
      ASSERT_EQ(spu_extract(spu_cmpabseq(x, y), 1), m == n ? ~0u : 0u)
          << std::hex << '|' << a << "| == |" << b;
      ASSERT_EQ(spu_extract(spu_cmpabsgt(x, y), 1), m > n ? ~0u : 0u) << std::hex << '|' << a << "| > |" << b;
    }
  }
}

TEST_F(IntrinsicsSingle, ComparesKeepLanesApart) {
  const vec_float4 a{1.0f, 2.0f, -3.0f, 0.0f}, b{1.0f, -2.0f, -1.0f, -0.0f};
  expect_lanes(spu_cmpeq(a, b), {~0u, 0, 0, ~0u}, "spu_cmpeq");
  expect_lanes(spu_cmpgt(a, b), {0, ~0u, 0, 0}, "spu_cmpgt");
  expect_lanes(spu_cmpabseq(a, b), {~0u, ~0u, 0, ~0u}, "spu_cmpabseq");
  expect_lanes(spu_cmpabsgt(a, b), {0, 0, ~0u, 0}, "spu_cmpabsgt");
}

}  // namespace
}  // namespace softcell::test
