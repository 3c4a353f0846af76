#pragma once

// [SPU-ISA, 6] Shift and rotate instructions, bit by bit: bit n of the result is some bit of RA, a zero or
// the sign.

#include "spu_model/instruction.h"

namespace softcell::spu_model::chapter {

/// What is shifted in.
enum class Fill { kZeros, kSign, kAround };

/// RA with each element of `width` bits moved to the left by count(i), which is negative to the right.
template <class Count>
Quadword moved(const Quadword& ra, int width, Fill fill, Count count) {
  Quadword result;
  for (int n = 0; n < 128; ++n) {
    const int first = n / width * width;  // the leftmost bit of this element
    int from = n - first + static_cast<int>(count(n / width));
    bool bit = false;
    if (fill == Fill::kAround) from = ((from % width) + width) % width;
    if (from >= 0 && from < width) {
      bit = ra.bit(first + from);
    } else if (fill == Fill::kSign) {
      bit = ra.bit(first);
    }
    result.set_bit(n, bit);
  }
  return result;
}

/// A count's rightmost bits: 0..2^bits - 1.
inline int low(std::uint32_t count, int bits) { return static_cast<int>(count & ((1u << bits) - 1)); }
/// Those of its negative: how far the "rotate and mask" instructions move to the right.
inline int low_of_negative(std::uint32_t count, int bits) { return low(0u - count, bits); }

// Halfwords: counts of 5 bits to shift, of 4 to rotate.
inline Quadword shlh(const Operands& o) {
  return moved(o.ra, 16, Fill::kZeros, [&](int i) { return low(o.rb.half(i), 5); });
}
inline Quadword shlhi(const Operands& o) {
  return moved(o.ra, 16, Fill::kZeros, [&](int) { return low(o.i7(), 5); });
}
inline Quadword roth(const Operands& o) {
  return moved(o.ra, 16, Fill::kAround, [&](int i) { return low(o.rb.half(i), 4); });
}
inline Quadword rothi(const Operands& o) {
  return moved(o.ra, 16, Fill::kAround, [&](int) { return low(o.i7(), 4); });
}
inline Quadword rothm(const Operands& o) {
  return moved(o.ra, 16, Fill::kZeros, [&](int i) { return -low_of_negative(o.rb.half(i), 5); });
}
inline Quadword rothmi(const Operands& o) {
  return moved(o.ra, 16, Fill::kZeros, [&](int) { return -low_of_negative(o.i7(), 5); });
}
inline Quadword rotmah(const Operands& o) {
  return moved(o.ra, 16, Fill::kSign, [&](int i) { return -low_of_negative(o.rb.half(i), 5); });
}
inline Quadword rotmahi(const Operands& o) {
  return moved(o.ra, 16, Fill::kSign, [&](int) { return -low_of_negative(o.i7(), 5); });
}

// Words: counts of 6 bits to shift, of 5 to rotate.
inline Quadword shl(const Operands& o) {
  return moved(o.ra, 32, Fill::kZeros, [&](int i) { return low(o.rb.word(i), 6); });
}
inline Quadword shli(const Operands& o) {
  return moved(o.ra, 32, Fill::kZeros, [&](int) { return low(o.i7(), 6); });
}
inline Quadword rot(const Operands& o) {
  return moved(o.ra, 32, Fill::kAround, [&](int i) { return low(o.rb.word(i), 5); });
}
inline Quadword roti(const Operands& o) {
  return moved(o.ra, 32, Fill::kAround, [&](int) { return low(o.i7(), 5); });
}
inline Quadword rotm(const Operands& o) {
  return moved(o.ra, 32, Fill::kZeros, [&](int i) { return -low_of_negative(o.rb.word(i), 6); });
}
inline Quadword rotmi(const Operands& o) {
  return moved(o.ra, 32, Fill::kZeros, [&](int) { return -low_of_negative(o.i7(), 6); });
}
inline Quadword rotma(const Operands& o) {
  return moved(o.ra, 32, Fill::kSign, [&](int i) { return -low_of_negative(o.rb.word(i), 6); });
}
inline Quadword rotmai(const Operands& o) {
  return moved(o.ra, 32, Fill::kSign, [&](int) { return -low_of_negative(o.i7(), 6); });
}

// Quadwords, by bits: counts of 3 bits.
inline Quadword by_bits(const Operands& o, Fill fill, int count) {
  return moved(o.ra, 128, fill, [&](int) { return count; });
}
inline Quadword shlqbi(const Operands& o) { return by_bits(o, Fill::kZeros, low(o.rb.word(0), 3)); }
inline Quadword shlqbii(const Operands& o) { return by_bits(o, Fill::kZeros, low(o.i7(), 3)); }
inline Quadword rotqbi(const Operands& o) { return by_bits(o, Fill::kAround, low(o.rb.word(0), 3)); }
inline Quadword rotqbii(const Operands& o) { return by_bits(o, Fill::kAround, low(o.i7(), 3)); }
inline Quadword rotqmbi(const Operands& o) {
  return by_bits(o, Fill::kZeros, -low_of_negative(o.rb.word(0), 3));
}
inline Quadword rotqmbii(const Operands& o) { return by_bits(o, Fill::kZeros, -low_of_negative(o.i7(), 3)); }

// Quadwords, by bytes: counts of 5 bits to shift, of 4 to rotate; a count of bits (...bybi) stands 3 bits
// further left.
inline Quadword shlqby(const Operands& o) { return by_bits(o, Fill::kZeros, 8 * low(o.rb.word(0), 5)); }
inline Quadword shlqbyi(const Operands& o) { return by_bits(o, Fill::kZeros, 8 * low(o.i7(), 5)); }
inline Quadword shlqbybi(const Operands& o) {
  return by_bits(o, Fill::kZeros, 8 * low(o.rb.word(0) >> 3, 5));
}
inline Quadword rotqby(const Operands& o) { return by_bits(o, Fill::kAround, 8 * low(o.rb.word(0), 4)); }
inline Quadword rotqbyi(const Operands& o) { return by_bits(o, Fill::kAround, 8 * low(o.i7(), 4)); }
inline Quadword rotqbybi(const Operands& o) {
  return by_bits(o, Fill::kAround, 8 * low(o.rb.word(0) >> 3, 4));
}
inline Quadword rotqmby(const Operands& o) {
  return by_bits(o, Fill::kZeros, -8 * low_of_negative(o.rb.word(0), 5));
}
inline Quadword rotqmbyi(const Operands& o) {
  return by_bits(o, Fill::kZeros, -8 * low_of_negative(o.i7(), 5));
}
inline Quadword rotqmbybi(const Operands& o) {
  return by_bits(o, Fill::kZeros, -8 * low_of_negative(o.rb.word(0) >> 3, 5));
}

}  // namespace softcell::spu_model::chapter
