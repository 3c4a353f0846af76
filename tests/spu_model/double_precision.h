#pragma once

// [SPU-ISA, 9] Double precision: IEEE 754 with four rounding modes, but denormal operands are zeros and every
// NaN that comes out is the same one; and the status and control register.
//
// FPSCR: bits 20..21 and 22..23 are the rounding modes of the left and the right doubleword. The flags of the
// left one are bits 50..55, of the right one 82..87: OVF, UNF, INX, INV, NaN, DENORM.

#include <optional>

#include "spu_model/exact_number.h"
#include "spu_model/instruction.h"

namespace softcell::spu_model::chapter {

enum class Rounding { kNearestEven = 0, kZero = 1, kUp = 2, kDown = 3 };

inline Rounding rounding_of(const Quadword& fpscr, int lane) {
  return static_cast<Rounding>((fpscr.bit(20 + 2 * lane) ? 2 : 0) + (fpscr.bit(21 + 2 * lane) ? 1 : 0));
}

/// Where a flag stands among the six of a doubleword.
enum DoubleFlag { kOverflow, kUnderflow, kInexact, kInvalid, kNotANumber, kDenormal };

inline void set_flag(Quadword& fpscr, int lane, DoubleFlag flag) {
  fpscr.set_bit((lane == 0 ? 50 : 82) + flag, true);
}

/// An IEEE 754 binary format.
struct BinaryFormat {
  int fraction_bits;
  int largest_exponent;  // unbiased; it is the bias, too
  int smallest_exponent() const { return 1 - largest_exponent; }
  std::uint64_t infinity() const { return field_mask() << fraction_bits; }
  std::uint64_t sign() const { return (field_mask() + 1) << fraction_bits; }
  std::uint64_t field_mask() const { return static_cast<std::uint64_t>(2 * largest_exponent + 1); }
};
constexpr BinaryFormat kBinary64{52, 1023};
constexpr BinaryFormat kBinary32{23, 127};
constexpr std::uint64_t kNan64 = 0x7FF8000000000000;
constexpr std::uint64_t kNan32 = 0x7FC00000;

/// What a word of a format means.
struct Number {
  bool negative = false;
  bool infinite = false;
  bool nan = false;
  bool signalling = false;
  bool denormal = false;
  ExactNumber value;  // of what is finite; of a denormal its true value
  bool is_zero() const { return !nan && !infinite && value.is_zero(); }
};

inline Number number_of(std::uint64_t word, const BinaryFormat& format) {
  const std::uint64_t fraction = word & ((1ull << format.fraction_bits) - 1);
  const int field = static_cast<int>(word >> format.fraction_bits & format.field_mask());
  Number number;
  number.negative = (word & format.sign()) != 0;
  const bool special = field == 2 * format.largest_exponent + 1;
  number.infinite = special && fraction == 0;
  number.nan = special && fraction != 0;
  number.signalling = number.nan && (fraction >> (format.fraction_bits - 1)) == 0;
  number.denormal = field == 0 && fraction != 0;
  if (special) return number;
  const std::uint64_t leading = field == 0 ? 0 : 1ull << format.fraction_bits;
  const int exponent = (field == 0 ? 1 : field) - format.largest_exponent - format.fraction_bits;
  number.value = ExactNumber(number.negative, fraction | leading, exponent);
  return number;
}

/// Reads an operand as instructions do: a denormal is a zero of its sign, and noted.
inline Number operand(std::uint64_t word, const BinaryFormat& format, Quadword& fpscr, int lane) {
  Number number = number_of(word, format);
  if (number.denormal) {
    set_flag(fpscr, lane, kDenormal);
    number.value = {};
  }
  return number;
}

/// Whether rounding moves the magnitude, cut off, one unit up.
inline bool rounds_away(const ExactNumber::Truncated& cut, bool negative, Rounding rounding) {
  if (cut.exact) return false;
  switch (rounding) {
    case Rounding::kNearestEven:
      return cut.against_half > 0 || (cut.against_half == 0 && cut.whole % 2 != 0);
    case Rounding::kZero:
      return false;
    case Rounding::kUp:
      return !negative;
    case Rounding::kDown:
      return negative;
  }
  return false;
}

/// |number| rounded to a multiple of 2^unit, in units of it, and whether that changed it.
inline std::uint64_t rounded_magnitude(const ExactNumber& number, int unit, Rounding rounding,
                                       bool& inexact) {
  const ExactNumber::Truncated cut = number.truncated(unit);
  inexact = !cut.exact;
  return cut.whole + (rounds_away(cut, number.is_negative(), rounding) ? 1 : 0);
}

/// The word of a number that is not zero, rounded once, with the flags of that. A result counts as tiny when
/// it is so after rounding to an unlimited range of exponents.
inline std::uint64_t rounded(const ExactNumber& number, const BinaryFormat& format, Rounding rounding,
                             Quadword& fpscr, int lane) {
  const bool negative = number.is_negative();
  const std::uint64_t sign = negative ? format.sign() : 0;
  const std::uint64_t hidden = 1ull << format.fraction_bits;
  bool inexact = false;

  int exponent = number.binary_exponent();
  const bool carries =
      rounded_magnitude(number, exponent - format.fraction_bits, rounding, inexact) == 2 * hidden;
  const bool tiny = exponent + (carries ? 1 : 0) < format.smallest_exponent();

  // A number below the normal ones is rounded to a multiple of the smallest denormal.
  if (exponent < format.smallest_exponent()) exponent = format.smallest_exponent();
  std::uint64_t significand = rounded_magnitude(number, exponent - format.fraction_bits, rounding, inexact);
  if (significand == 2 * hidden) {
    significand = hidden;
    ++exponent;
  }
  if (inexact) set_flag(fpscr, lane, kInexact);
  if (inexact && tiny) set_flag(fpscr, lane, kUnderflow);
  if (exponent > format.largest_exponent) {
    set_flag(fpscr, lane, kOverflow);
    set_flag(fpscr, lane, kInexact);
    const bool stays_finite = rounding == Rounding::kZero || (rounding == Rounding::kUp && negative) ||
                              (rounding == Rounding::kDown && !negative);
    return sign | (format.infinity() - (stays_finite ? 1 : 0));
  }
  if (significand < hidden) return sign | significand;
  return sign | static_cast<std::uint64_t>(exponent + format.largest_exponent) << format.fraction_bits |
         (significand - hidden);
}

/// x + y in one lane, both exact: products and sums alike end here.
inline std::uint64_t rounded_sum(const Number& x, const Number& y, Quadword& fpscr, int lane) {
  const Rounding rounding = rounding_of(fpscr, lane);
  if (x.infinite && y.infinite && x.negative != y.negative) {
    set_flag(fpscr, lane, kInvalid);
    return kNan64;
  }
  if (x.infinite || y.infinite) {
    return kBinary64.infinity() | ((x.infinite ? x.negative : y.negative) ? kBinary64.sign() : 0);
  }
  const ExactNumber exact = x.value.plus(y.value);
  if (!exact.is_zero()) return rounded(exact, kBinary64, rounding, fpscr, lane);
  // Zeros of one sign keep it; otherwise the sum is +0, but -0 when rounding down.
  const bool both_zeros = x.is_zero() && y.is_zero();
  const bool negative = both_zeros && x.negative == y.negative ? x.negative : rounding == Rounding::kDown;
  return negative ? kBinary64.sign() : 0;
}

/// Whether an operand is a NaN, with its flags.
inline bool notes_nan(const Number& number, Quadword& fpscr, int lane) {
  if (number.nan) set_flag(fpscr, lane, kNotANumber);
  if (number.signalling) set_flag(fpscr, lane, kInvalid);
  return number.nan;
}

inline std::uint64_t double_sum(std::uint64_t a, std::uint64_t b, bool subtract, Quadword& fpscr, int lane) {
  const Number x = operand(a, kBinary64, fpscr, lane);
  Number y = operand(b, kBinary64, fpscr, lane);
  const bool x_is_nan = notes_nan(x, fpscr, lane);
  const bool y_is_nan = notes_nan(y, fpscr, lane);
  if (x_is_nan || y_is_nan) return kNan64;
  if (subtract) {
    y.negative = !y.negative;
    y.value = y.value.negated();
  }
  return rounded_sum(x, y, fpscr, lane);
}

/// x * y, exact, with the sign that a zero or an infinity has; or nothing when one is infinite and the other
/// zero.
inline std::optional<Number> exact_product(const Number& x, const Number& y) {
  if ((x.infinite && y.is_zero()) || (y.infinite && x.is_zero())) return {};
  Number product;
  product.negative = x.negative != y.negative;
  product.infinite = x.infinite || y.infinite;
  if (!product.infinite) product.value = x.value.times(y.value);
  return product;
}

inline std::uint64_t double_product(std::uint64_t a, std::uint64_t b, Quadword& fpscr, int lane) {
  const Number x = operand(a, kBinary64, fpscr, lane);
  const Number y = operand(b, kBinary64, fpscr, lane);
  const bool x_is_nan = notes_nan(x, fpscr, lane);
  const bool y_is_nan = notes_nan(y, fpscr, lane);
  if (x_is_nan || y_is_nan) return kNan64;
  const auto product = exact_product(x, y);
  if (!product) {
    set_flag(fpscr, lane, kInvalid);
    return kNan64;
  }
  const std::uint64_t sign = product->negative ? kBinary64.sign() : 0;
  if (product->infinite) return kBinary64.infinity() | sign;
  if (product->value.is_zero()) return sign;
  return rounded(product->value, kBinary64, rounding_of(fpscr, lane), fpscr, lane);
}

/// a * b + c or a * b - c, rounded once, then negated if asked for. A NaN is never negated.
inline std::uint64_t double_multiply_add(const Operands& o, bool subtract, bool negate, Quadword& fpscr,
                                         int lane) {
  const Number x = operand(o.ra.doubleword(lane), kBinary64, fpscr, lane);
  const Number y = operand(o.rb.doubleword(lane), kBinary64, fpscr, lane);
  Number z = operand(o.rt.doubleword(lane), kBinary64, fpscr, lane);
  const bool x_is_nan = notes_nan(x, fpscr, lane);
  const bool y_is_nan = notes_nan(y, fpscr, lane);
  const bool z_is_nan = notes_nan(z, fpscr, lane);
  if (x_is_nan || y_is_nan) return kNan64;
  const auto product = exact_product(x, y);
  if (!product) set_flag(fpscr, lane, kInvalid);
  if (!product || z_is_nan) return kNan64;
  if (subtract) {
    z.negative = !z.negative;
    z.value = z.value.negated();
  }
  const std::uint64_t sum = rounded_sum(*product, z, fpscr, lane);
  return negate && sum != kNan64 ? sum ^ kBinary64.sign() : sum;
}

inline Quadword dfa(const Operands& o, Quadword& fpscr) {
  return each_doubleword(
      [&](int i) { return double_sum(o.ra.doubleword(i), o.rb.doubleword(i), false, fpscr, i); });
}
inline Quadword dfs(const Operands& o, Quadword& fpscr) {
  return each_doubleword(
      [&](int i) { return double_sum(o.ra.doubleword(i), o.rb.doubleword(i), true, fpscr, i); });
}
inline Quadword dfm(const Operands& o, Quadword& fpscr) {
  return each_doubleword(
      [&](int i) { return double_product(o.ra.doubleword(i), o.rb.doubleword(i), fpscr, i); });
}
inline Quadword dfma(const Operands& o, Quadword& fpscr) {
  return each_doubleword([&](int i) { return double_multiply_add(o, false, false, fpscr, i); });
}
inline Quadword dfms(const Operands& o, Quadword& fpscr) {
  return each_doubleword([&](int i) { return double_multiply_add(o, true, false, fpscr, i); });
}
inline Quadword dfnms(const Operands& o, Quadword& fpscr) {
  return each_doubleword([&](int i) { return double_multiply_add(o, true, true, fpscr, i); });
}
inline Quadword dfnma(const Operands& o, Quadword& fpscr) {
  return each_doubleword([&](int i) { return double_multiply_add(o, false, true, fpscr, i); });
}

// Conversions between the left word of a doubleword and the doubleword.

inline Quadword fesd(const Operands& o, Quadword& fpscr) {
  return each_doubleword([&](int i) -> std::uint64_t {
    const Number x = operand(o.ra.word(2 * i), kBinary32, fpscr, i);
    if (notes_nan(x, fpscr, i)) return kNan64;
    const std::uint64_t sign = x.negative ? kBinary64.sign() : 0;
    if (x.infinite) return kBinary64.infinity() | sign;
    if (x.value.is_zero()) return sign;
    return rounded(x.value, kBinary64, rounding_of(fpscr, i), fpscr, i);
  });
}
inline Quadword frds(const Operands& o, Quadword& fpscr) {
  return each_doubleword([&](int i) -> std::uint64_t {
    const Number x = operand(o.ra.doubleword(i), kBinary64, fpscr, i);
    if (notes_nan(x, fpscr, i)) return kNan32 << 32;
    const std::uint64_t sign = x.negative ? kBinary32.sign() : 0;
    if (x.infinite) return (kBinary32.infinity() | sign) << 32;
    if (x.value.is_zero()) return sign << 32;
    return rounded(x.value, kBinary32, rounding_of(fpscr, i), fpscr, i) << 32;
  });
}

/// The bits of FPSCR that exist.
inline Quadword writable_fpscr() {
  Quadword mask;
  mask.set_word(0, 0x00000F07);
  mask.set_word(1, 0x00003F07);
  mask.set_word(2, 0x00003F07);
  mask.set_word(3, 0x00000F07);
  return mask;
}
inline StepResult fscrwr(Machine& m, const Operands& o) {
  m.fpscr = each_byte([&](int i) { return o.ra.byte(i) & writable_fpscr().byte(i); });
  return {};
}
inline Quadword fscrrd(const Operands&, Quadword& fpscr) { return fpscr; }

// Of the PowerXCell 8i alone: compares and the test for special values.

inline bool ordered(const Number& x, const Number& y) { return !x.nan && !y.nan; }
/// Whether x > y, neither a NaN.
inline bool greater(const Number& x, const Number& y) {
  if (x.infinite || y.infinite) {
    const int rank_x = x.infinite ? (x.negative ? -1 : 1) : 0;
    const int rank_y = y.infinite ? (y.negative ? -1 : 1) : 0;
    return rank_x > rank_y;
  }
  const ExactNumber difference = x.value.plus(y.value.negated());
  return !difference.is_zero() && !difference.is_negative();
}
inline bool equal(const Number& x, const Number& y) { return !greater(x, y) && !greater(y, x); }

/// Each doubleword is all ones where holds(x, y), of RA and RB, with the bits of `kept` only.
template <class Holds>
Quadword each_comparison(const Operands& o, std::uint64_t kept, Holds holds) {
  return each_doubleword([&](int i) {
    const Number x = number_of(o.ra.doubleword(i) & kept, kBinary64);
    const Number y = number_of(o.rb.doubleword(i) & kept, kBinary64);
    return ordered(x, y) && holds(x, y) ? ~0ull : 0;
  });
}
constexpr std::uint64_t kAllBits = ~0ull;
constexpr std::uint64_t kMagnitude = ~0ull >> 1;
inline Quadword dfceq(const Operands& o) { return each_comparison(o, kAllBits, equal); }
inline Quadword dfcmeq(const Operands& o) { return each_comparison(o, kMagnitude, equal); }
inline Quadword dfcgt(const Operands& o) { return each_comparison(o, kAllBits, greater); }
inline Quadword dfcmgt(const Operands& o) { return each_comparison(o, kMagnitude, greater); }
inline Quadword dftsv(const Operands& o) {
  return each_doubleword([&](int i) {
    const Number x = number_of(o.ra.doubleword(i), kBinary64);
    const auto asked = [&](int bit) { return o.bits(bit, bit) != 0; };  // 11..17 of the instruction
    const bool is_one = (x.nan && asked(11)) || (x.infinite && asked(x.negative ? 13 : 12)) ||
                        (x.is_zero() && asked(x.negative ? 15 : 14)) ||
                        (x.denormal && asked(x.negative ? 17 : 16));
    return is_one ? ~0ull : 0;
  });
}

}  // namespace softcell::spu_model::chapter
