#pragma once
// binary16 numbers ("half floats"): conversion from float, rounded to the nearest, in integer arithmetic.

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

}  // namespace softcell::ppu
