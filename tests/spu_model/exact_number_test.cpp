#include "spu_model/exact_number.h"

#include <gtest/gtest.h>

#include <random>

namespace softcell::spu_model {
namespace {

ExactNumber whole(std::int64_t value) {
  return {value < 0, static_cast<std::uint64_t>(value < 0 ? -value : value), 0};
}

std::int64_t value_of(const ExactNumber& number) {
  if (number.is_zero()) return 0;
  const auto magnitude = static_cast<std::int64_t>(number.truncated(0).whole);
  return number.is_negative() ? -magnitude : magnitude;
}

TEST(ExactNumber, AddsAndMultipliesAsIntegersDo) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 10000; ++i) {
    const auto a = static_cast<std::int64_t>(random()) >> (34 + random() % 20);
    const auto b = static_cast<std::int64_t>(random()) >> (34 + random() % 20);
    const auto c = static_cast<std::int64_t>(random()) >> (10 + random() % 50);
    ASSERT_EQ(value_of(whole(a).times(whole(b)).plus(whole(c))), a * b + c) << a << " " << b << " " << c;
  }
}

TEST(ExactNumber, KeepsWhatIsFarApart) {
  const ExactNumber one(false, 1, 0);
  const ExactNumber tiny(false, 1, -3000);
  const auto below = one.plus(tiny.negated()).truncated(-10);
  EXPECT_EQ(below.whole, 1023u);
  EXPECT_FALSE(below.exact);
  EXPECT_EQ(below.against_half, 1);
  EXPECT_EQ(one.plus(tiny.negated()).binary_exponent(), -1);
  EXPECT_TRUE(one.plus(tiny).plus(one.negated()).plus(tiny.negated()).is_zero());
  EXPECT_EQ(one.plus(tiny).plus(one.negated()).binary_exponent(), -3000);
}

TEST(ExactNumber, ComparesWhatIsCutOffWithHalfAUnit) {
  const auto cut = [](std::uint64_t quarters) { return ExactNumber(false, quarters, -2).truncated(0); };
  EXPECT_TRUE(cut(8).exact);
  EXPECT_EQ(cut(9).against_half, -1);
  EXPECT_EQ(cut(10).against_half, 0);
  EXPECT_EQ(cut(11).against_half, 1);
  EXPECT_EQ(cut(11).whole, 2u);
}

}  // namespace
}  // namespace softcell::spu_model
