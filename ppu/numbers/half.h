#pragma once
// binary16 numbers ("half floats"): conversion from and to float, exact, in integer arithmetic.

#include <bit>
#include <cstdint>

namespace softcell::ppu {

/// The nearest binary16, ties to even. Magnitudes from 65520 on become infinity, up to 2^-25 zero; a NaN becomes a quiet NaN with the top
/// nine bits of its payload.
constexpr std::uint16_t half_from_float(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = (bits >> 16) & 0x8000u;
  const std::uint32_t magnitude = bits & 0x7FFFFFFFu;
  std::uint32_t half = 0;
  if (magnitude > 0x7F800000u) {
    half = 0x7E00u | ((magnitude >> 13) & 0x3FFu);
  } else if (magnitude >= 0x477FF000u) {  // 65520 and beyond
    half = 0x7C00u;
  } else if (magnitude >=
             0x38800000u) {  // 2^-14 and beyond: normal; rebias the exponent from 127 to 15 and round
    half = (magnitude - (112u << 23) + 0xFFFu + ((magnitude >> 13) & 1u)) >> 13;
  } else if (magnitude >
             0x33000000u) {  // beyond 2^-25: subnormal; shift the fraction with its hidden bit, and round
    const std::uint32_t shift = 126u - (magnitude >> 23);  // 14..24
    const std::uint32_t fraction = (magnitude & 0x7FFFFFu) | 0x800000u;
    half = (fraction + (1u << (shift - 1)) - 1u + ((fraction >> shift) & 1u)) >> shift;
  }
  return static_cast<std::uint16_t>(sign | half);
}

/// The same value as a float.
constexpr float float_from_half(std::uint16_t half) {
  const std::uint32_t sign = (half & 0x8000u) << 16;
  const std::uint32_t exponent = (half >> 10) & 31u, fraction = half & 0x3FFu;
  if (exponent == 31u) return std::bit_cast<float>(sign | 0x7F800000u | (fraction << 13));
  if (exponent != 0) return std::bit_cast<float>(sign | ((exponent + 112u) << 23) | (fraction << 13));
  const float magnitude = static_cast<float>(fraction) * 0x1p-24f;
  return sign != 0 ? -magnitude : magnitude;
}

}  // namespace softcell::ppu
