// Doubles that the interpreter computes in integers, against those of the host's unit in the same mode.

#include "interpreter/double_in_integers.h"

#include <gtest/gtest.h>
#include <immintrin.h>

#include <bit>
#include <cstdint>
#include <random>

#include "interpreter/double_semantics.h"

namespace softcell::ls_sim::interpreter::semantics {
namespace {

/// Operands whose sums cancel, round by a tie or a single bit, or lie far from each other.
class Operands {
 public:
  std::uint64_t next() {
    const std::uint64_t random = generator_();
    std::uint64_t exponent = is_near_ ? 963 + random % 120 : random % 2048;
    std::uint64_t fraction = generator_() & (kImplicitOne - 1);
    switch (random >> 32 & 7) {
      case 0:
        fraction &= ~((std::uint64_t{1} << (random >> 40) % 53) - 1);
        break;
      case 1:
        fraction |= (std::uint64_t{1} << (random >> 40) % 53) - 1;
        break;
      case 2:
        fraction = 0;
        break;
      case 3:
        exponent = 1023;
        break;
      default:
        break;
    }
    return random >> 63 << 63 | exponent << kFractionBits | fraction;
  }
  /// All operands of one sum are near each other or anywhere.
  void begin_sum() { is_near_ = generator_() % 8 != 0; }
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(generator_() % count); }

 private:
  std::mt19937_64 generator_{20061111};
  bool is_near_ = true;
};

TEST(DoubleInIntegers, HasTheBitsAndTheFlagsOfTheHost) {
  Operands operands;
  int compared = 0;
  for (int i = 0; i < 400000; ++i) {
    operands.begin_sum();
    const std::uint64_t x = operands.next(), y = operands.next();
    std::uint64_t z = operands.next();
    // Or an addend that takes nearly all of the product away.
    if (operands.below(4) == 0)
      z = std::bit_cast<std::uint64_t>(-(std::bit_cast<double>(x) * std::bit_cast<double>(y))) +
          operands.below(3) - 1;
    const std::uint32_t rounding = operands.below(4);
    const auto rounded = fused_in_integers(x, y, z, rounding);
    if (!rounded) continue;
    ++compared;
    std::uint32_t flags = 0;
    const std::uint64_t expected = bits_of(in_mode(
        rounding, of_bits(x), of_bits(y), of_bits(z),
        [](__m128d a, __m128d b, __m128d c) { return _mm_fmadd_sd(a, b, c); }, flags));
    ASSERT_EQ(rounded->bits, expected)
        << std::hex << x << " * " << y << " + " << z << ", rounding " << rounding;
    ASSERT_EQ(rounded->is_inexact ? Fpscr::kDoubleInexact : 0u, flags)
        << std::hex << x << " * " << y << " + " << z;
  }
  EXPECT_GT(compared, 350000);
}

TEST(DoubleInIntegers, BecomesTheSingleOfTheHost) {
  Operands operands;
  int compared = 0;
  for (int i = 0; i < 200000; ++i) {
    operands.begin_sum();
    const std::uint64_t x = operands.next();
    const std::uint32_t rounding = operands.below(4);
    const auto rounded = single_in_integers(x, rounding);
    if (!rounded) continue;
    ++compared;
    std::uint32_t flags = 0;
    const __m128d expected = in_mode(
        rounding, of_bits(x), __m128d{}, __m128d{},
        [](__m128d a, __m128d, __m128d) { return (__m128d)_mm_cvtsd_ss(_mm_setzero_ps(), a); }, flags);
    ASSERT_EQ(rounded->bits, ((U32x4)expected)[0]) << std::hex << x << ", rounding " << rounding;
    ASSERT_EQ(rounded->is_inexact ? Fpscr::kDoubleInexact : 0u, flags) << std::hex << x;
  }
  EXPECT_GT(compared, 150000);
}

TEST(DoubleInIntegers, ZerosHaveTheSignOfTheMode) {
  const std::uint64_t one = 0x3FF0000000000000, minus_one = one | kDoubleSign;
  for (std::uint32_t rounding = 0; rounding < 4; ++rounding) {
    const std::uint64_t zero = rounding == 3 ? kDoubleSign : 0;
    EXPECT_EQ(fused_in_integers(one, one, minus_one, rounding)->bits, zero);
    EXPECT_EQ(fused_in_integers(0, one, kDoubleSign, rounding)->bits, zero);
    EXPECT_EQ(fused_in_integers(kDoubleSign, one, kDoubleSign, rounding)->bits, kDoubleSign);
    EXPECT_EQ(fused_in_integers(0, minus_one, one, rounding)->bits, one);
  }
}

TEST(DoubleInIntegers, LeavesWhatIsNotOrdinaryToTheHost) {
  const std::uint64_t one = 0x3FF0000000000000, largest = 0x7FEFFFFFFFFFFFFF, smallest = 0x0010000000000000;
  for (const std::uint64_t other : {kDoubleInfinity, kTheNan, std::uint64_t{1}}) {
    EXPECT_FALSE(fused_in_integers(other, one, one, 0));
    EXPECT_FALSE(fused_in_integers(one, other, one, 0));
    EXPECT_FALSE(fused_in_integers(one, one, other, 0));
    EXPECT_FALSE(single_in_integers(other, 0));
  }
  EXPECT_FALSE(fused_in_integers(largest, largest, one, 0));
  EXPECT_FALSE(fused_in_integers(largest, one, largest, 0));
  EXPECT_FALSE(fused_in_integers(smallest, smallest, 0, 0));
  EXPECT_FALSE(single_in_integers(largest, 0));
  EXPECT_FALSE(single_in_integers(smallest, 0));
}

}  // namespace
}  // namespace softcell::ls_sim::interpreter::semantics
