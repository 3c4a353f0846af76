#pragma once

// [SPU-ISA, 9] Single precision: truncated, without infinities and NaNs, denormals read and written as zero;
// each operation is exact before its one rounding.
//
// FPSCR's flags of word i are its bits 32 i + 29 (OVF), + 30 (UNF) and + 31 (DIFF: a number was met or made
// that IEEE 754 would treat otherwise); bit 116 + i: an estimate of zero's reciprocal.

#include "spu_model/exact_number.h"
#include "spu_model/instruction.h"

namespace softcell::spu_model::chapter {

struct SingleFlags {
  bool overflow = false;
  bool underflow = false;
  bool difference = false;
};

constexpr std::uint32_t kLargestMagnitude = 0x7FFFFFFF;  // (2 - 2^-23) 2^128 [SPU-ISA, 9.1] documented

inline int single_exponent(std::uint32_t word) { return static_cast<int>(word >> 23 & 0xFF); }

/// The number that a word stands for.
inline ExactNumber single_value(std::uint32_t word) {
  if (single_exponent(word) == 0) return {};
  return {word >> 31 != 0, (word & 0x7FFFFF) | 0x800000, single_exponent(word) - 127 - 23};
}

/// The word of a number, and flags.
inline std::uint32_t truncated_single(const ExactNumber& number, SingleFlags& flags) {
  if (number.is_zero()) return 0;
  const std::uint32_t sign = number.is_negative() ? 0x80000000 : 0;
  const int exponent = number.binary_exponent();
  if (exponent < -126) {
    flags.underflow = flags.difference = true;
    return 0;
  }
  if (exponent > 128) {
    flags.overflow = flags.difference = true;
    return sign | kLargestMagnitude;
  }
  if (exponent == 128) flags.difference = true;
  const auto significand = static_cast<std::uint32_t>(number.truncated(exponent - 23).whole);
  return sign | static_cast<std::uint32_t>(exponent + 127) << 23 | (significand & 0x7FFFFF);
}

/// Whether IEEE 754 would read the operand as something else: a denormal, an infinity or a NaN.
inline bool reads_differently(std::uint32_t word) {
  return single_exponent(word) == 255 || (single_exponent(word) == 0 && (word & 0x7FFFFF) != 0);
}

inline void set_flags(Quadword& fpscr, int i, const SingleFlags& flags) {
  if (flags.overflow) fpscr.set_bit(32 * i + 29, true);
  if (flags.underflow) fpscr.set_bit(32 * i + 30, true);
  if (flags.difference) fpscr.set_bit(32 * i + 31, true);
}

/// Each word is number(i), truncated; `operands` are those whose words say whether IEEE 754 differs.
template <class Number, class... Register>
Quadword each_single(Quadword& fpscr, Number number, const Register&... operands) {
  return each_word([&](int i) {
    SingleFlags flags;
    flags.difference = (reads_differently(operands.word(i)) || ...);
    const std::uint32_t word = truncated_single(number(i), flags);
    set_flags(fpscr, i, flags);
    return word;
  });
}

inline ExactNumber product(const Operands& o, int i) {
  return single_value(o.ra.word(i)).times(single_value(o.rb.word(i)));
}

inline Quadword fa(const Operands& o, Quadword& fpscr) {
  const auto number = [&](int i) { return single_value(o.ra.word(i)).plus(single_value(o.rb.word(i))); };
  return each_single(fpscr, number, o.ra, o.rb);
}
inline Quadword fs(const Operands& o, Quadword& fpscr) {
  const auto number = [&](int i) {
    return single_value(o.ra.word(i)).plus(single_value(o.rb.word(i)).negated());
  };
  return each_single(fpscr, number, o.ra, o.rb);
}
inline Quadword fm(const Operands& o, Quadword& fpscr) {
  return each_single(
      fpscr, [&](int i) { return product(o, i); }, o.ra, o.rb);
}
inline Quadword fma(const Operands& o, Quadword& fpscr) {
  const auto number = [&](int i) { return product(o, i).plus(single_value(o.rc.word(i))); };
  return each_single(fpscr, number, o.ra, o.rb, o.rc);
}
inline Quadword fnms(const Operands& o, Quadword& fpscr) {
  const auto number = [&](int i) { return single_value(o.rc.word(i)).plus(product(o, i).negated()); };
  return each_single(fpscr, number, o.ra, o.rb, o.rc);
}
inline Quadword fms(const Operands& o, Quadword& fpscr) {
  const auto number = [&](int i) { return product(o, i).plus(single_value(o.rc.word(i)).negated()); };
  return each_single(fpscr, number, o.ra, o.rb, o.rc);
}

// Compares: by the order of the numbers.

/// -1, 0, 1 as a < b, a == b, a > b.
inline int order(const ExactNumber& a, const ExactNumber& b) {
  const ExactNumber difference = a.plus(b.negated());
  return difference.is_zero() ? 0 : difference.is_negative() ? -1 : 1;
}
inline int single_order(const Operands& o, int i) {
  return order(single_value(o.ra.word(i)), single_value(o.rb.word(i)));
}
inline int single_magnitude_order(const Operands& o, int i) {
  return order(single_value(o.ra.word(i) & 0x7FFFFFFF), single_value(o.rb.word(i) & 0x7FFFFFFF));
}
inline Quadword fceq(const Operands& o) {
  return each_word([&](int i) { return single_order(o, i) == 0 ? ~0u : 0; });
}
inline Quadword fcmeq(const Operands& o) {
  return each_word([&](int i) { return single_magnitude_order(o, i) == 0 ? ~0u : 0; });
}
inline Quadword fcgt(const Operands& o) {
  return each_word([&](int i) { return single_order(o, i) > 0 ? ~0u : 0; });
}
inline Quadword fcmgt(const Operands& o) {
  return each_word([&](int i) { return single_magnitude_order(o, i) > 0 ? ~0u : 0; });
}

// Conversions. The instruction holds 155 - n for an integer divided by 2^n, and 173 - n for a number times
// 2^n.

inline Quadword csflt(const Operands& o, Quadword& fpscr) {
  return each_single(fpscr, [&](int i) {
    const std::int64_t integer = s32(o.ra.word(i));
    const auto magnitude = static_cast<std::uint64_t>(integer < 0 ? -integer : integer);
    return ExactNumber(integer < 0, magnitude, o.i8() - 155);
  });
}
inline Quadword cuflt(const Operands& o, Quadword& fpscr) {
  return each_single(fpscr, [&](int i) { return ExactNumber(false, o.ra.word(i), o.i8() - 155); });
}
/// |RA's word i| * 2^n, cut off, at most 2^32.
inline std::uint64_t scaled_magnitude(const Operands& o, int i) {
  const ExactNumber number = single_value(o.ra.word(i)).times(ExactNumber(false, 1, 173 - o.i8()));
  if (number.is_zero()) return 0;
  return number.binary_exponent() >= 32 ? 1ull << 32 : number.truncated(0).whole;
}
inline Quadword cflts(const Operands& o) {
  return each_word([&](int i) -> std::int64_t {
    const std::uint64_t magnitude = scaled_magnitude(o, i);
    if (o.ra.bit(32 * i))
      return magnitude >= 1ull << 31 ? -(1ll << 31) : -static_cast<std::int64_t>(magnitude);
    return magnitude >= 1ull << 31 ? 0x7FFFFFFF : static_cast<std::int64_t>(magnitude);
  });
}
inline Quadword cfltu(const Operands& o) {
  return each_word([&](int i) -> std::uint64_t {
    if (o.ra.bit(32 * i)) return 0;
    const std::uint64_t magnitude = scaled_magnitude(o, i);
    return magnitude >= 1ull << 32 ? 0xFFFFFFFF : magnitude;
  });
}

}  // namespace softcell::spu_model::chapter
