#pragma once

// [SPU-ISA, 4] Constant formation, [SPU-ISA, 5] integer and logical instructions.

#include <bit>

#include "spu_model/instruction.h"

namespace softcell::spu_model::chapter {

// Constants.
inline Quadword ilh(const Operands& o) {
  return each_half([&](int) { return o.bits(9, 24); });
}
inline Quadword ilhu(const Operands& o) {
  return each_word([&](int) { return o.bits(9, 24) << 16; });
}
inline Quadword il(const Operands& o) {
  return each_word([&](int) { return o.i16(); });
}
inline Quadword ila(const Operands& o) {
  return each_word([&](int) { return o.i18(); });
}
inline Quadword iohl(const Operands& o) {
  return each_word([&](int i) { return o.rt.word(i) | o.bits(9, 24); });
}
inline Quadword fsmbi(const Operands& o) {
  return each_byte([&](int i) { return o.bits(9 + i, 9 + i) != 0 ? 0xFF : 0; });
}

// Addition and subtraction. A subtraction takes RA from RB.
inline Quadword ah(const Operands& o) {
  return each_half([&](int i) { return o.ra.half(i) + o.rb.half(i); });
}
inline Quadword ahi(const Operands& o) {
  return each_half([&](int i) { return o.ra.half(i) + o.i10(); });
}
inline Quadword a(const Operands& o) {
  return each_word([&](int i) { return o.ra.word(i) + o.rb.word(i); });
}
inline Quadword ai(const Operands& o) {
  return each_word([&](int i) { return o.ra.word(i) + o.i10(); });
}
inline Quadword sfh(const Operands& o) {
  return each_half([&](int i) { return o.rb.half(i) - o.ra.half(i); });
}
inline Quadword sfhi(const Operands& o) {
  return each_half([&](int i) { return o.i10() - o.ra.half(i); });
}
inline Quadword sf(const Operands& o) {
  return each_word([&](int i) { return o.rb.word(i) - o.ra.word(i); });
}
inline Quadword sfi(const Operands& o) {
  return each_word([&](int i) { return o.i10() - o.ra.word(i); });
}

/// RA + RB + carry in, 33 bits.
inline std::uint64_t sum(const Operands& o, int i, std::uint64_t carry_in) {
  return std::uint64_t{o.ra.word(i)} + o.rb.word(i) + carry_in;
}
/// RB + (not RA) + carry in, 33 bits: a carry out of 1 means that nothing was borrowed.
inline std::uint64_t difference(const Operands& o, int i, std::uint64_t carry_in) {
  return std::uint64_t{o.rb.word(i)} + (o.ra.word(i) ^ 0xFFFFFFFFu) + carry_in;
}
inline std::uint64_t carry_in(const Operands& o, int i) { return o.rt.word(i) & 1; }

inline Quadword addx(const Operands& o) {
  return each_word([&](int i) { return sum(o, i, carry_in(o, i)); });
}
inline Quadword cg(const Operands& o) {
  return each_word([&](int i) { return sum(o, i, 0) >> 32; });
}
inline Quadword cgx(const Operands& o) {
  return each_word([&](int i) { return sum(o, i, carry_in(o, i)) >> 32; });
}
inline Quadword sfx(const Operands& o) {
  return each_word([&](int i) { return difference(o, i, carry_in(o, i)); });
}
inline Quadword bg(const Operands& o) {
  return each_word([&](int i) { return difference(o, i, 1) >> 32; });
}
inline Quadword bgx(const Operands& o) {
  return each_word([&](int i) { return difference(o, i, carry_in(o, i)) >> 32; });
}

// Multiplication of halfwords: half 2i is the left one of word i, half 2i + 1 the right one.
inline std::uint32_t left(const Quadword& q, int i) { return q.half(2 * i); }
inline std::uint32_t right(const Quadword& q, int i) { return q.half(2 * i + 1); }

inline Quadword mpy(const Operands& o) {
  return each_word([&](int i) { return s16(right(o.ra, i)) * s16(right(o.rb, i)); });
}
inline Quadword mpyu(const Operands& o) {
  return each_word([&](int i) { return right(o.ra, i) * right(o.rb, i); });
}
inline Quadword mpyi(const Operands& o) {
  return each_word([&](int i) { return s16(right(o.ra, i)) * o.i10(); });
}
inline Quadword mpyui(const Operands& o) {
  return each_word([&](int i) { return right(o.ra, i) * static_cast<std::uint64_t>(o.i10() & 0xFFFF); });
}
inline Quadword mpya(const Operands& o) {
  return each_word([&](int i) { return s16(right(o.ra, i)) * s16(right(o.rb, i)) + s32(o.rc.word(i)); });
}
inline Quadword mpyh(const Operands& o) {
  return each_word([&](int i) { return std::uint64_t{left(o.ra, i)} * right(o.rb, i) << 16; });
}
inline Quadword mpys(const Operands& o) {
  return each_word([&](int i) {
    const std::int64_t product = s16(right(o.ra, i)) * s16(right(o.rb, i));
    return s16(static_cast<std::uint64_t>(product) >> 16);
  });
}
inline Quadword mpyhh(const Operands& o) {
  return each_word([&](int i) { return s16(left(o.ra, i)) * s16(left(o.rb, i)); });
}
inline Quadword mpyhha(const Operands& o) {
  return each_word([&](int i) { return s16(left(o.ra, i)) * s16(left(o.rb, i)) + s32(o.rt.word(i)); });
}
inline Quadword mpyhhu(const Operands& o) {
  return each_word([&](int i) { return left(o.ra, i) * left(o.rb, i); });
}
inline Quadword mpyhhau(const Operands& o) {
  return each_word([&](int i) { return left(o.ra, i) * left(o.rb, i) + o.rt.word(i); });
}

// Counts, masks and gathers.
inline Quadword clz(const Operands& o) {
  return each_word([&](int i) {
    int zeros = 0;
    while (zeros < 32 && !o.ra.bit(32 * i + zeros)) ++zeros;
    return zeros;
  });
}
inline Quadword cntb(const Operands& o) {
  return each_byte([&](int i) {
    int ones = 0;
    for (int bit = 0; bit < 8; ++bit) ones += o.ra.bit(8 * i + bit) ? 1 : 0;
    return ones;
  });
}
/// Element i of `size` bytes is all ones where bit i of the rightmost 16 / size bits of RA's preferred word
/// is one.
inline Quadword form_select_mask(const Operands& o, int size) {
  const int count = 16 / size;
  return each_element(size, [&](int i) { return o.ra.bit(32 - count + i) ? ~0ull : 0; });
}
inline Quadword fsmb(const Operands& o) { return form_select_mask(o, 1); }
inline Quadword fsmh(const Operands& o) { return form_select_mask(o, 2); }
inline Quadword fsm(const Operands& o) { return form_select_mask(o, 4); }
/// The rightmost bit of each element of `size` bytes, side by side at the right of the preferred word.
inline Quadword gather_bits(const Operands& o, int size) {
  const int count = 16 / size;
  Quadword result;
  for (int i = 0; i < count; ++i) result.set_bit(32 - count + i, o.ra.bit(8 * size * (i + 1) - 1));
  return result;
}
inline Quadword gbb(const Operands& o) { return gather_bits(o, 1); }
inline Quadword gbh(const Operands& o) { return gather_bits(o, 2); }
inline Quadword gb(const Operands& o) { return gather_bits(o, 4); }

// Bytes, and extensions of the sign.
inline Quadword avgb(const Operands& o) {
  return each_byte([&](int i) { return (o.ra.byte(i) + o.rb.byte(i) + 1) / 2; });
}
inline Quadword absdb(const Operands& o) {
  return each_byte([&](int i) {
    return o.rb.byte(i) > o.ra.byte(i) ? o.rb.byte(i) - o.ra.byte(i) : o.ra.byte(i) - o.rb.byte(i);
  });
}
inline Quadword sumb(const Operands& o) {
  return each_half([&](int i) {
    const Quadword& from = i % 2 == 0 ? o.rb : o.ra;
    int total = 0;
    for (int byte = 0; byte < 4; ++byte) total += from.byte(i / 2 * 4 + byte);
    return total;
  });
}
inline Quadword xsbh(const Operands& o) {
  return each_half([&](int i) { return s8(o.ra.half(i)); });
}
inline Quadword xshw(const Operands& o) {
  return each_word([&](int i) { return s16(o.ra.word(i)); });
}
inline Quadword xswd(const Operands& o) {
  return each_doubleword([&](int i) { return s32(o.ra.doubleword(i)); });
}
inline Quadword orx(const Operands& o) {
  return preferred_word(o.ra.word(0) | o.ra.word(1) | o.ra.word(2) | o.ra.word(3));
}

// Logic. Names with an underscore are operators of C++.
inline Quadword and_(const Operands& o) {
  return each_byte([&](int i) { return o.ra.byte(i) & o.rb.byte(i); });
}
inline Quadword andc(const Operands& o) {
  return each_byte([&](int i) { return o.ra.byte(i) & ~o.rb.byte(i); });
}
inline Quadword andbi(const Operands& o) {
  return each_byte([&](int i) { return o.ra.byte(i) & o.i10(); });
}
inline Quadword andhi(const Operands& o) {
  return each_half([&](int i) { return o.ra.half(i) & o.i10(); });
}
inline Quadword andi(const Operands& o) {
  return each_word([&](int i) { return o.ra.word(i) & o.i10(); });
}
inline Quadword or_(const Operands& o) {
  return each_byte([&](int i) { return o.ra.byte(i) | o.rb.byte(i); });
}
inline Quadword orc(const Operands& o) {
  return each_byte([&](int i) { return o.ra.byte(i) | ~o.rb.byte(i); });
}
inline Quadword orbi(const Operands& o) {
  return each_byte([&](int i) { return o.ra.byte(i) | o.i10(); });
}
inline Quadword orhi(const Operands& o) {
  return each_half([&](int i) { return o.ra.half(i) | o.i10(); });
}
inline Quadword ori(const Operands& o) {
  return each_word([&](int i) { return o.ra.word(i) | o.i10(); });
}
inline Quadword xor_(const Operands& o) {
  return each_byte([&](int i) { return o.ra.byte(i) ^ o.rb.byte(i); });
}
inline Quadword xorbi(const Operands& o) {
  return each_byte([&](int i) { return o.ra.byte(i) ^ o.i10(); });
}
inline Quadword xorhi(const Operands& o) {
  return each_half([&](int i) { return o.ra.half(i) ^ o.i10(); });
}
inline Quadword xori(const Operands& o) {
  return each_word([&](int i) { return o.ra.word(i) ^ o.i10(); });
}
inline Quadword nand(const Operands& o) {
  return each_byte([&](int i) { return ~(o.ra.byte(i) & o.rb.byte(i)); });
}
inline Quadword nor(const Operands& o) {
  return each_byte([&](int i) { return ~(o.ra.byte(i) | o.rb.byte(i)); });
}
inline Quadword eqv(const Operands& o) {
  return each_byte([&](int i) { return ~(o.ra.byte(i) ^ o.rb.byte(i)); });
}

inline Quadword selb(const Operands& o) {
  Quadword result;
  for (int n = 0; n < 128; ++n) result.set_bit(n, o.rc.bit(n) ? o.rb.bit(n) : o.ra.bit(n));
  return result;
}
inline Quadword shufb(const Operands& o) {
  return each_byte([&](int i) -> int {
    const int control = o.rc.byte(i);
    if (control >> 6 == 0b10) return 0x00;
    if (control >> 5 == 0b110) return 0xFF;
    if (control >> 5 == 0b111) return 0x80;
    const int from = control & 0b11111;
    return from < 16 ? o.ra.byte(from) : o.rb.byte(from - 16);
  });
}

}  // namespace softcell::spu_model::chapter
