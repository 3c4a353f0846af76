#pragma once

// [SPU-ISA, 9] frest, frsqest and fi. The architecture fixes the form of an estimate, sign, exponent, a base
// fraction of 13 bits and a step of 10; which base and step each argument has was read off consoles. The
// tables have both, as they stand in the word.

#include <array>

#include "spu_model/single_precision.h"

namespace softcell::spu_model::chapter {

// By the five leftmost bits of the argument's fraction.
constexpr std::array<std::uint32_t, 32> kReciprocals{
    0x7FFBE0, 0x7F87A6, 0x70EF72, 0x708B40, 0x638B12, 0x633AEA, 0x5792C4, 0x574AA0,
    0x4CCA7E, 0x4C9262, 0x430A44, 0x42D62A, 0x3A2E12, 0x39FDFA, 0x3215E4, 0x31F1D2,
    0x2AA9BE, 0x2A85AC, 0x23D59A, 0x23BD8E, 0x1D8576, 0x1D8576, 0x17AD5A, 0x17AD5A,
    0x124543, 0x124543, 0x0D392D, 0x0D392D, 0x08851A, 0x08851A, 0x041D07, 0x041D07};
// Of arguments whose exponent field is even, odd.
constexpr std::array<std::array<std::uint32_t, 32>, 2> kReciprocalRoots{
    {{0x350160, 0x34E954, 0x2F993D, 0x2F993D, 0x2AA523, 0x2AA523, 0x26190D, 0x26190D,
      0x21E4F9, 0x21E4F9, 0x1E00E9, 0x1E00E9, 0x1A5CD9, 0x1A5CD9, 0x16F8CB, 0x16F8CB,
      0x13CCC0, 0x13CCC0, 0x10CCB3, 0x10CCB3, 0x0E00AA, 0x0E00AA, 0x0B58A1, 0x0B58A1,
      0x08D498, 0x08D498, 0x067491, 0x067491, 0x043089, 0x043089, 0x020C83, 0x020C83},
     {0x7FFDF4, 0x7FD1DE, 0x7859C8, 0x783DBA, 0x71559C, 0x71559C, 0x6AE57C, 0x6AE57C,
      0x64F561, 0x64F561, 0x5F7149, 0x5F7149, 0x5A4D33, 0x5A4D33, 0x55811F, 0x55811F,
      0x51050F, 0x51050F, 0x4CC8FE, 0x4CC8FE, 0x48D0F0, 0x48D0F0, 0x4510E4, 0x4510E4,
      0x4180D7, 0x4180D7, 0x3E24CC, 0x3E24CC, 0x3AF4C3, 0x3AF4C3, 0x37E8BA, 0x37E8BA}}};

inline std::uint32_t fraction_index(std::uint32_t word) { return word >> 18 & 31; }

/// Notes the estimate of a zero.
inline void note_zero(std::uint32_t word, int i, Quadword& fpscr) {
  if (single_exponent(word) == 0) fpscr.set_bit(116 + i, true);
}

inline Quadword frest(const Operands& o, Quadword& fpscr) {
  return each_word([&](int i) {
    const std::uint32_t x = o.ra.word(i);
    note_zero(x, i, fpscr);
    const int e = single_exponent(x);
    const int exponent = e == 0 ? 255 : e > 253 ? 0 : 253 - e;
    return (x & 0x80000000) | static_cast<std::uint32_t>(exponent) << 23 | kReciprocals.at(fraction_index(x));
  });
}
inline Quadword frsqest(const Operands& o, Quadword& fpscr) {
  return each_word([&](int i) {
    const std::uint32_t x = o.ra.word(i);
    note_zero(x, i, fpscr);
    const int e = single_exponent(x);
    const int exponent = e == 0 ? 255 : 190 - (e + 1) / 2;
    return static_cast<std::uint32_t>(exponent) << 23 |
           kReciprocalRoots.at(static_cast<std::size_t>(e % 2)).at(fraction_index(x));
  });
}

/// With the base 1.b and the step s of RB, and the 19 rightmost bits of RA's fraction as a fraction Y of one:
/// 1.b - s 2^-13 Y, here in units of 2^-32, cut off to 23 bits of fraction.
inline Quadword fi(const Operands& o) {
  return each_word([&](int i) -> std::uint32_t {
    const std::uint32_t estimate = o.rb.word(i);
    const std::int64_t base = std::int64_t{1} << 32 | std::int64_t{estimate >> 10 & 0x1FFF} << 19;
    const std::int64_t step = estimate & 0x3FF;
    const std::int64_t y = o.ra.word(i) & 0x7FFFF;
    const std::int64_t interpolated = base - step * y;
    const std::uint32_t sign_and_exponent = estimate & 0xFF800000;
    if (interpolated >= std::int64_t{1} << 32) {
      return sign_and_exponent | static_cast<std::uint32_t>(interpolated >> 9 & 0x7FFFFF);
    }
    return (sign_and_exponent - 0x800000) | static_cast<std::uint32_t>(interpolated >> 8 & 0x7FFFFF);
  });
}

}  // namespace softcell::spu_model::chapter
