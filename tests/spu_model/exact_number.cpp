#include "spu_model/exact_number.h"

#include <algorithm>
#include <utility>

namespace softcell::spu_model {

ExactNumber::ExactNumber(bool negative, std::uint64_t magnitude, int exponent)
    : negative_(negative), exponent_(exponent) {
  for (; magnitude != 0; magnitude >>= 32) limbs_.push_back(static_cast<std::uint32_t>(magnitude));
}

ExactNumber ExactNumber::negated() const {
  ExactNumber result = *this;
  result.negative_ = !negative_;
  return result;
}

ExactNumber ExactNumber::times(const ExactNumber& other) const {
  ExactNumber result;
  result.negative_ = negative_ != other.negative_;
  result.exponent_ = exponent_ + other.exponent_;
  result.limbs_.assign(limbs_.size() + other.limbs_.size(), 0);
  for (std::size_t i = 0; i < limbs_.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < other.limbs_.size(); ++j) {
      carry += std::uint64_t{limbs_[i]} * other.limbs_[j] + result.limbs_[i + j];
      result.limbs_[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    result.limbs_[i + other.limbs_.size()] = static_cast<std::uint32_t>(carry);
  }
  trim(result.limbs_);
  return result;
}

ExactNumber ExactNumber::plus(const ExactNumber& other) const {
  if (is_zero()) return other;
  if (other.is_zero()) return *this;
  ExactNumber result;
  result.exponent_ = std::min(exponent_, other.exponent_);
  const Limbs mine = shifted_left(limbs_, exponent_ - result.exponent_);
  const Limbs others = shifted_left(other.limbs_, other.exponent_ - result.exponent_);
  if (negative_ == other.negative_) {
    result.negative_ = negative_;
    result.limbs_ = sum(mine, others);
    return result;
  }
  const bool mine_is_larger = compared(mine, others) >= 0;
  result.negative_ = mine_is_larger ? negative_ : other.negative_;
  result.limbs_ = mine_is_larger ? difference(mine, others) : difference(others, mine);
  return result;
}

int ExactNumber::binary_exponent() const {
  int bits = 0;
  for (std::uint32_t top = limbs_.back(); top != 0; top >>= 1) ++bits;
  return exponent_ + 32 * static_cast<int>(limbs_.size() - 1) + bits - 1;
}

ExactNumber::Truncated ExactNumber::truncated(int unit) const {
  const std::int64_t cut = std::int64_t{unit} - exponent_;  // bits of the magnitude that are below the unit
  Truncated result;
  for (int i = 63; i >= 0; --i) result.whole = result.whole << 1 | (bit(cut + i) ? 1 : 0);
  const bool half = bit(cut - 1);
  const bool below_half = any_bit_below(cut - 1);
  result.exact = !half && !below_half;
  result.against_half = !half ? -1 : below_half ? 1 : 0;
  return result;
}

bool ExactNumber::bit(std::int64_t n) const {
  if (n < 0 || n >= 32 * static_cast<std::int64_t>(limbs_.size())) return false;
  return (limbs_[static_cast<std::size_t>(n / 32)] >> n % 32 & 1) != 0;
}

bool ExactNumber::any_bit_below(std::int64_t n) const {
  if (n <= 0) return false;
  const auto whole = static_cast<std::size_t>(n / 32);
  for (std::size_t i = 0; i < std::min(whole, limbs_.size()); ++i) {
    if (limbs_[i] != 0) return true;
  }
  return whole < limbs_.size() && (limbs_[whole] & ((1ull << n % 32) - 1)) != 0;
}

ExactNumber::Limbs ExactNumber::shifted_left(const Limbs& limbs, int bits) {
  const int within = bits % 32;
  Limbs result(static_cast<std::size_t>(bits / 32), 0);
  std::uint64_t carry = 0;
  for (const std::uint32_t limb : limbs) {
    carry |= std::uint64_t{limb} << within;
    result.push_back(static_cast<std::uint32_t>(carry));
    carry >>= 32;
  }
  result.push_back(static_cast<std::uint32_t>(carry));
  trim(result);
  return result;
}

int ExactNumber::compared(const Limbs& a, const Limbs& b) {
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  for (std::size_t i = a.size(); i-- > 0;) {
    if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
  }
  return 0;
}

ExactNumber::Limbs ExactNumber::sum(const Limbs& a, const Limbs& b) {
  Limbs result;
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    carry += std::uint64_t{i < a.size() ? a[i] : 0} + (i < b.size() ? b[i] : 0);
    result.push_back(static_cast<std::uint32_t>(carry));
    carry >>= 32;
  }
  result.push_back(static_cast<std::uint32_t>(carry));
  trim(result);
  return result;
}

ExactNumber::Limbs ExactNumber::difference(const Limbs& larger, const Limbs& smaller) {
  Limbs result;
  std::int64_t rest = 0;  // what is borrowed: 0 or -1
  for (std::size_t i = 0; i < larger.size(); ++i) {
    rest += std::int64_t{larger[i]} - (i < smaller.size() ? smaller[i] : 0);
    result.push_back(static_cast<std::uint32_t>(rest));
    rest >>= 32;
  }
  trim(result);
  return result;
}

void ExactNumber::trim(Limbs& limbs) {
  while (!limbs.empty() && limbs.back() == 0) limbs.pop_back();
}

}  // namespace softcell::spu_model
