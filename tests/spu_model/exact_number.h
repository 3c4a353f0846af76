#pragma once

// Exact binary numbers of any size, and their one rounding: what floating-point results are defined by.

#include <cstdint>
#include <vector>

namespace softcell::spu_model {

/// (-1)^negative * magnitude * 2^exponent, without any limit.
class ExactNumber {
 public:
  ExactNumber() = default;
  ExactNumber(bool negative, std::uint64_t magnitude, int exponent);

  bool is_zero() const { return limbs_.empty(); }
  bool is_negative() const { return negative_; }  // of a zero: meaningless
  ExactNumber negated() const;
  ExactNumber times(const ExactNumber& other) const;
  ExactNumber plus(const ExactNumber& other) const;
  /// n with 2^n <= |this| < 2^(n + 1). @pre not zero
  int binary_exponent() const;

  /// |this| in units of 2^unit, cut off, with what was cut off. @pre the result fits 64 bits
  struct Truncated {
    std::uint64_t whole = 0;
    bool exact = true;      // nothing was cut off
    int against_half = -1;  // what was cut off is less than (-1), exactly (0) or more than (1) half a unit
  };
  Truncated truncated(int unit) const;

 private:
  using Limbs = std::vector<std::uint32_t>;  // the lowest first, no zeros at the end
  bool bit(std::int64_t n) const;            // bit n of the magnitude, 0 the lowest
  bool any_bit_below(std::int64_t n) const;
  static Limbs shifted_left(const Limbs& limbs, int bits);
  static int compared(const Limbs& a, const Limbs& b);
  static Limbs sum(const Limbs& a, const Limbs& b);
  static Limbs difference(const Limbs& larger, const Limbs& smaller);
  static void trim(Limbs& limbs);

  bool negative_ = false;
  Limbs limbs_;
  int exponent_ = 0;
};

}  // namespace softcell::spu_model
