// Reciprocal estimates and their interpolation: the tables as published, the integer rules, known vectors.
#include <sstream>
#include <string>
#include <vector>

#include "intrinsics_support.h"
#include "support/published_estimates.h"

namespace softcell::test {
namespace {

class IntrinsicsEstimate : public SpuArithmetic {};

/// Fractions in hexadecimal; "x2" repeats the one before it. [second-hand: read off hardware by the RPCS3
/// project]
std::vector<std::uint32_t> parse(const char* text) {
  std::vector<std::uint32_t> table;
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    table.push_back(word == "x2" ? table.back() : static_cast<std::uint32_t>(std::stoul(word, nullptr, 16)));
  }
  return table;
}

const std::vector<std::uint32_t> kReciprocal = parse(
    "7FFBE0 7F87A6 70EF72 708B40 638B12 633AEA 5792C4 574AA0 4CCA7E 4C9262 430A44 42D62A 3A2E12 39FDFA "
    "3215E4 31F1D2 "
    "2AA9BE 2A85AC 23D59A 23BD8E 1D8576 x2 17AD5A x2 124543 x2 0D392D x2 08851A x2 041D07 x2");
const std::vector<std::uint32_t> kReciprocalSquareRoot = parse(
    "350160 34E954 2F993D x2 2AA523 x2 26190D x2 21E4F9 x2 1E00E9 x2 1A5CD9 x2 16F8CB x2 13CCC0 x2 10CCB3 x2 "
    "0E00AA x2 0B58A1 x2 08D498 x2 067491 x2 043089 x2 020C83 x2 "
    "7FFDF4 7FD1DE 7859C8 783DBA 71559C x2 6AE57C x2 64F561 x2 5F7149 x2 5A4D33 x2 55811F x2 51050F x2 "
    "4CC8FE x2 "
    "48D0F0 x2 4510E4 x2 4180D7 x2 3E24CC x2 3AF4C3 x2 37E8BA x2");

std::uint32_t frest(std::uint32_t a) {
  const int e = static_cast<int>(a >> 23 & 0xFF);
  const int exponent = e == 0 ? 255 : std::max(0, 253 - e);
  return (a & 0x80000000) | static_cast<std::uint32_t>(exponent) << 23 | kReciprocal[a >> 18 & 31];
}
std::uint32_t frsqest(std::uint32_t a) {
  const int e = static_cast<int>(a >> 23 & 0xFF);
  const int exponent = e == 0 ? 255 : 190 - (e + 1) / 2;
  const std::size_t index = static_cast<std::size_t>((e & 1) << 5) | (a >> 18 & 31);
  return static_cast<std::uint32_t>(exponent) << 23 | kReciprocalSquareRoot[index];
}
std::uint32_t fi(std::uint32_t a, std::uint32_t b) {
  const std::int64_t base = std::int64_t{b & 0x7FFC00} << 9,
                     product = std::int64_t{b & 0x3FF} * (a & 0x7FFFF);
  if (product <= base) return (b & 0xFF800000) | static_cast<std::uint32_t>(base - product) >> 9;
  return ((b & 0xFF800000) - 0x00800000) | (static_cast<std::uint32_t>(base - product) >> 8 & 0x7FFFFF);
}

std::uint32_t si(qword q) { return si_to_uint(q); }

void expect_estimates(std::uint32_t x) {
  const qword q = si_from_uint(x);
  ASSERT_EQ(si(si_frest(q)), frest(x)) << std::hex << x;
  ASSERT_EQ(si(si_frsqest(q)), frsqest(x)) << std::hex << x;
  ASSERT_EQ(si(si_fi(q, si_frest(q))), fi(x, frest(x))) << std::hex << x;
  const vec_float4 v(spu_splats(x));
  ASSERT_EQ(spu_extract(vec_uint4(spu_re(v)), 3), fi(x, frest(x))) << std::hex << x;
  ASSERT_EQ(spu_extract(vec_uint4(spu_rsqrte(v)), 3), fi(x, frsqest(x))) << std::hex << x;
}

TEST_F(IntrinsicsEstimate, EveryExponentAndTableEntry) {
  ASSERT_EQ(kReciprocal.size(), 32u);
  ASSERT_EQ(kReciprocalSquareRoot.size(), 64u);
  Operands operands(60);
  for (std::uint32_t head = 0; head < 1u << 14; ++head) {  // sign, exponent, index
    ASSERT_NO_FATAL_FAILURE(expect_estimates(head << 18));
    ASSERT_NO_FATAL_FAILURE(
        expect_estimates(head << 18 | (static_cast<std::uint32_t>(operands.bits()) & 0x3FFFF)));
    ASSERT_NO_FATAL_FAILURE(expect_estimates(head << 18 | 0x3FFFF));
  }
}

TEST_F(IntrinsicsEstimate, InterpolationOfUnrelatedOperands) {
  Operands operands(61);
  int borrows = 0;
  for (int round = 0; round < 100000; ++round) {
    const auto a = static_cast<std::uint32_t>(operands.bits());
    auto b = static_cast<std::uint32_t>(operands.bits());
    if (round % 2 == 0) b &= 0xFF803FFF;  // a small base: the product is often larger
    borrows += (std::uint64_t{b & 0x3FF} * (a & 0x7FFFF) > std::uint64_t{b & 0x7FFC00} << 9) ? 1 : 0;
    ASSERT_EQ(si(si_fi(si_from_uint(a), si_from_uint(b))), fi(a, b)) << std::hex << a << ", " << b;
  }
  EXPECT_GT(borrows, 1000);
}

TEST_F(IntrinsicsEstimate, KnownVectors) {
  for (const PublishedEstimate& known : kPublishedEstimates) {
    const qword x = si_from_uint(known.x);
    EXPECT_EQ(si(si_frest(x)), known.reciprocal) << std::hex << known.x;
    EXPECT_EQ(si(si_fi(x, si_frest(x))), known.interpolated_reciprocal) << std::hex << known.x;
    EXPECT_EQ(si(si_frsqest(x)), known.root) << std::hex << known.x;
    EXPECT_EQ(si(si_fi(x, si_frsqest(x))), known.interpolated_root) << std::hex << known.x;
  }
}

}  // namespace
}  // namespace softcell::test
