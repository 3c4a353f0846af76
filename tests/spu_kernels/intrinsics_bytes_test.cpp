// Casts, shuffles and quadword shifts against a register of sixteen big-endian bytes.
#include "intrinsics_support.h"

#include <array>
#include <cstring>

namespace softcell::test {
namespace {

class IntrinsicsBytes : public SpuArithmetic {};

TEST_F(IntrinsicsBytes, CastsKeepTheBytesOfTheRegister) {
  for_each(AllVectors{}, []<class From>() {
    for_each(AllVectors{}, []<class To>() {
      Operands operands(30);
      for (int round = 0; round < 50; ++round) {
        const From from = operands.vector<From>();
        ASSERT_EQ(register_of((To)from), register_of(from));
        ASSERT_EQ(register_of((To)(qword)from), register_of(from));
        if (sizeof(typename From::Lane) == sizeof(typename To::Lane)) {
          const To to(from);
          ASSERT_EQ(std::memcmp(&to, &from, 16), 0) << "between equal widths lanes stay";
        }
      }
    });
  });
}

TEST_F(IntrinsicsBytes, ACastToBytesBeginsWithTheMostSignificantByteOfWordZero) {
  const vec_uchar16 bytes = (vec_uchar16)(vec_uint4{0x00112233u, 0x44556677u, 0x8899AABBu, 0xCCDDEEFFu});
  for (int i = 0; i < 16; ++i) EXPECT_EQ(spu_extract(bytes, i), 0x11 * i);
}

TEST_F(IntrinsicsBytes, LaneZeroIsFirstInMemoryAndMissingLanesAreZero) {
  const vec_int4 a{1, -2, 3};
  const std::array<int, 4> expected{1, -2, 3, 0};
  EXPECT_EQ(std::memcmp(&a, &expected, 16), 0);
  const vec_float4 none{};
  EXPECT_EQ(register_of(none), Register{});
  static_assert(std::is_trivially_copyable_v<vec_double2> && sizeof(qword) == 16 && alignof(qword) == 16);
}

/// shufb as the manual says it. [SPU-ISA, shufb] documented
Register shufb(const Register& a, const Register& b, const Register& pattern) {
  Register result;
  for (std::size_t i = 0; i < 16; ++i) {
    const std::uint8_t c = pattern.byte[i];
    if ((c & 0xC0) == 0x80) {
      result.byte[i] = 0x00;
    } else if ((c & 0xE0) == 0xC0) {
      result.byte[i] = 0xFF;
    } else if ((c & 0xE0) == 0xE0) {
      result.byte[i] = 0x80;
    } else {
      result.byte[i] = (c & 0x10) != 0 ? b.byte[c & 15] : a.byte[c & 15];
    }
  }
  return result;
}

TEST_F(IntrinsicsBytes, ShufflesTakeAnyPatternForEveryWidth) {
  for_each(AllVectors{}, []<class V>() {
    Operands operands(31);
    for (int round = 0; round < 4 * kRounds; ++round) {
      const V a = operands.vector<V>(), b = operands.vector<V>();
      Register pattern;
      for (auto& byte : pattern.byte)
        byte = static_cast<std::uint8_t>(operands.bits() & (round % 2 == 0 ? 0xFF : 0x1F));
      ASSERT_EQ(register_of(spu_shuffle(a, b, vector_of<vec_uchar16>(pattern))),
                shufb(register_of(a), register_of(b), pattern))
          << "a " << register_of(a) << "b " << register_of(b) << "pattern " << pattern;
    }
  });
}

template <class V>
void expect_constant_pattern(const vec_uchar16& folded, const V& actual, const V& a, const V& b) {
  ASSERT_EQ(register_of(actual), shufb(register_of(a), register_of(b), register_of(folded)));
}

TEST_F(IntrinsicsBytes, ShufflesWithConstantPatterns) {
  for_each(AllVectors{}, []<class V>() {
    Operands operands(32);
    const V a = operands.vector<V>(), b = operands.vector<V>();
    // The compiler sees the pattern here: a merge, a reversal of bytes, constants in between, one operand
    // only.
    const vec_uchar16 merge = {0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23};
    const vec_uchar16 reverse = {31, 30, 29, 28, 27, 26, 25, 24, 7, 6, 5, 4, 3, 2, 1, 0};
    const vec_uchar16 constants = {0x80, 0xC0, 0xE0, 0xFF, 0xBF, 0xDF, 5,    21,
                                   0x7F, 0x60, 0x20, 0x9F, 1,    2,    0x81, 0xC1};
    const vec_uchar16 second = {16, 17, 18, 19, 16, 17, 18, 19, 16, 17, 18, 19, 16, 17, 18, 19};
    expect_constant_pattern(merge, spu_shuffle(a, b, merge), a, b);
    expect_constant_pattern(reverse, spu_shuffle(a, b, reverse), a, b);
    expect_constant_pattern(constants, spu_shuffle(a, b, constants), a, b);
    expect_constant_pattern(second, spu_shuffle(a, b, second), a, b);
  });
}

// ---- quadword shifts, bit by bit: bit 0 is the most significant

bool bit(const Register& r, int i) {
  return i >= 0 && i < 128 && (r.byte[static_cast<std::size_t>(i / 8)] >> (7 - i % 8) & 1) != 0;
}

/// Bit i of the result is bit i + shift of the operand, which is 0 outside, or taken modulo 128.
Register moved(const Register& r, int shift, bool rotate) {
  Register result;
  for (int i = 0; i < 128; ++i) {
    const int from = rotate ? (i + shift + 128) % 128 : i + shift;
    if (bit(r, from))
      result.byte[static_cast<std::size_t>(i / 8)] |= static_cast<std::uint8_t>(0x80 >> i % 8);
  }
  return result;
}

#define SC_CHECK_QUADWORD(name, shift, rotate)                                     \
  for_each(AllVectors{}, []<class V>() {                                           \
    Operands operands(33);                                                         \
    for (int round = 0; round < 2 * kRounds; ++round) {                            \
      const V a = operands.vector<V>();                                            \
      const int n = round < 300 ? round - 150 : static_cast<int>(operands.bits()); \
      ASSERT_EQ(register_of(name(a, n)), moved(register_of(a), shift, rotate))     \
          << #name " by " << n << " of " << register_of(a);                        \
    }                                                                              \
  })

TEST_F(IntrinsicsBytes, QuadwordShiftsToTheLeft) {
  SC_CHECK_QUADWORD(spu_slqw, n & 7, false);
  SC_CHECK_QUADWORD(spu_slqwbyte, 8 * (n & 31), false);
  SC_CHECK_QUADWORD(spu_slqwbytebc, 8 * (n >> 3 & 31), false);
}

TEST_F(IntrinsicsBytes, QuadwordRotates) {
  SC_CHECK_QUADWORD(spu_rlqw, n & 7, true);
  SC_CHECK_QUADWORD(spu_rlqwbyte, 8 * (n & 15), true);
  SC_CHECK_QUADWORD(spu_rlqwbytebc, 8 * (n >> 3 & 15), true);
}

TEST_F(IntrinsicsBytes, QuadwordShiftsToTheRight) {
  SC_CHECK_QUADWORD(spu_rlmaskqw, -(static_cast<int>(0u - static_cast<unsigned int>(n)) & 7), false);
  SC_CHECK_QUADWORD(spu_rlmaskqwbyte, -8 * (static_cast<int>(0u - static_cast<unsigned int>(n)) & 31), false);
  SC_CHECK_QUADWORD(spu_rlmaskqwbytebc, -8 * (-(n >> 3) & 31), false);
  SC_CHECK_QUADWORD(spu_srqw, -(n & 7), false);
  SC_CHECK_QUADWORD(spu_srqwbyte, -8 * (n & 31), false);
  SC_CHECK_QUADWORD(spu_srqwbytebc, -8 * (n >> 3 & 31), false);
}

}  // namespace
}  // namespace softcell::test
