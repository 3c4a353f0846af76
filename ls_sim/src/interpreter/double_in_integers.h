#pragma once
// Arithmetic of ordinary doubles in integers: no operand and no result is denormal, infinite or a NaN.
//
// The host can do it, but only after a change of its rounding mode, and a change with a look at the flags takes up to
// 200 ns. This takes a tenth, and computes all four modes alike.

#include <bit>
#include <cstdint>
#include <optional>

namespace softcell::ls_sim::interpreter::semantics {

/// A number that was rounded, and whether that changed it.
template <class Bits>
struct Rounded {
  Bits bits;
  bool is_inexact;
};

/// Whether a number's last place goes up. @param rounding  as in FPSCR: 0 nearest, 1 towards zero, 2 up, 3 down
template <class Rest>
bool rounds_up(std::uint32_t rounding, bool is_negative, bool is_odd, Rest rest, Rest half) {
  switch (rounding) {
    case 0:
      return rest > half || (rest == half && is_odd);
    case 2:
      return !is_negative && rest != 0;
    case 3:
      return is_negative && rest != 0;
    default:
      return false;
  }
}

inline constexpr int kFractionBits = 52;
inline constexpr std::uint64_t kImplicitOne = std::uint64_t{1} << kFractionBits;

inline int exponent_field(std::uint64_t bits) { return static_cast<int>(bits >> kFractionBits & 0x7FF); }
inline std::uint64_t significand(std::uint64_t bits) { return (bits & (kImplicitOne - 1)) | kImplicitOne; }
inline bool is_ordinary(std::uint64_t bits) {
  return exponent_field(bits) - 1 < 0x7FE && exponent_field(bits) != 0;
}
inline bool is_zero(std::uint64_t bits) { return bits << 1 == 0; }

__extension__ using Wide = unsigned __int128;

/// Shifts to the right; a last bit of 1 stands for all ones that were shifted out.
inline Wide shifted_with_rest(Wide value, int by) {
  if (by == 0) return value;
  if (by >= 127) return value != 0;
  return value >> by | ((value & ((Wide{1} << by) - 1)) != 0);
}

inline int leading_zeros(Wide value) {
  const auto high = static_cast<std::uint64_t>(value >> 64);
  return high != 0 ? std::countl_zero(high) : 64 + std::countl_zero(static_cast<std::uint64_t>(value));
}

/// @param value  at least 2^71 or exact, so that its last bit may stand for a rest.
/// @return value * 2^unit; none if the result is not ordinary. @pre value != 0
inline std::optional<Rounded<std::uint64_t>> rounded_double(bool is_negative, Wide value, int unit,
                                                            std::uint32_t rounding) {
  constexpr int kDropped = 128 - 53;
  const int zeros = leading_zeros(value);
  value <<= zeros;
  const Wide rest = value & ((Wide{1} << kDropped) - 1);
  auto kept = static_cast<std::uint64_t>(value >> kDropped);
  int exponent = unit - zeros + kDropped + 1023 + kFractionBits;
  if (exponent < 1) return {};
  if (rounds_up(rounding, is_negative, (kept & 1) != 0, rest, Wide{1} << (kDropped - 1)) &&
      ++kept == kImplicitOne << 1) {
    kept >>= 1;
    ++exponent;
  }
  if (exponent > 0x7FE) return {};
  return Rounded<std::uint64_t>{std::uint64_t{is_negative} << 63 |
                                    static_cast<std::uint64_t>(exponent) << kFractionBits |
                                    (kept & (kImplicitOne - 1)),
                                rest != 0};
}

/// x * y + z, rounded once. Each operand is ordinary or zero, else there is no result.
inline std::optional<Rounded<std::uint64_t>> fused_in_integers(std::uint64_t x, std::uint64_t y,
                                                               std::uint64_t z, std::uint32_t rounding) {
  const auto fits = [](std::uint64_t bits) { return is_ordinary(bits) || is_zero(bits); };
  if (!fits(x) || !fits(y) || !fits(z)) return {};
  const bool product_is_negative = (x ^ y) >> 63 != 0, is_negative = z >> 63 != 0;
  const std::uint64_t zero_of_difference = std::uint64_t{rounding == 3} << 63;
  const bool product_is_zero = is_zero(x) || is_zero(y);
  if (product_is_zero && is_zero(z))
    return Rounded<std::uint64_t>{product_is_negative == is_negative ? z : zero_of_difference, false};
  if (product_is_zero) return Rounded<std::uint64_t>{z, false};

  // Both have their highest bit at 124 or 125. So their sum does not overflow, and bits that are shifted out are below those of the result.
  Wide product = Wide{significand(x)} * significand(y) << 20;
  const int unit_of_product = exponent_field(x) + exponent_field(y) - 2 * (1023 + kFractionBits) - 20;
  if (is_zero(z)) return rounded_double(product_is_negative, product, unit_of_product, rounding);
  Wide addend = Wide{significand(z)} << 72;
  const int unit_of_addend = exponent_field(z) - (1023 + kFractionBits) - 72;
  const int unit = unit_of_product > unit_of_addend ? unit_of_product : unit_of_addend;
  product = shifted_with_rest(product, unit - unit_of_product);
  addend = shifted_with_rest(addend, unit - unit_of_addend);
  if (product_is_negative == is_negative)
    return rounded_double(is_negative, product + addend, unit, rounding);
  if (product == addend) return Rounded<std::uint64_t>{zero_of_difference, false};
  return product > addend ? rounded_double(product_is_negative, product - addend, unit, rounding)
                          : rounded_double(is_negative, addend - product, unit, rounding);
}

/// An ordinary double as a single, if that is ordinary, too.
inline std::optional<Rounded<std::uint32_t>> single_in_integers(std::uint64_t bits, std::uint32_t rounding) {
  constexpr int kDropped = 29;
  int exponent = exponent_field(bits) - 1023 + 127;
  if (!is_ordinary(bits) || exponent < 1) return {};
  const bool is_negative = bits >> 63 != 0;
  const std::uint64_t rest = significand(bits) & ((std::uint64_t{1} << kDropped) - 1);
  auto kept = static_cast<std::uint32_t>(significand(bits) >> kDropped);
  if (rounds_up(rounding, is_negative, (kept & 1) != 0, rest, std::uint64_t{1} << (kDropped - 1)) &&
      ++kept == 1u << 24) {
    kept >>= 1;
    ++exponent;
  }
  if (exponent > 0xFE) return {};
  return Rounded<std::uint32_t>{
      std::uint32_t{is_negative} << 31 | static_cast<std::uint32_t>(exponent) << 23 | (kept & 0x7FFFFFu),
      rest != 0};
}

}  // namespace softcell::ls_sim::interpreter::semantics
