#pragma once
// Constants, integer arithmetic, logic and compares of elements. Each function is one instruction, returns
// its target, and is named as the instruction. [SPU-ISA] documented
#include "quadword.h"

namespace softcell::ls_sim::interpreter::semantics {

// ---- constants

inline Quadword ilh(const In& in) { return (Quadword)splat_half(in.imm); }
inline Quadword ilhu(const In& in) { return splat_word(in.imm) << 16; }
inline Quadword il(const In& in) { return splat_word(in.imm); }
inline Quadword ila(const In& in) { return splat_word(in.imm); }
inline Quadword iohl(const In& in) { return in.t | splat_word(in.imm & 0xFFFF); }

// ---- add, subtract

inline Quadword ah(const In& in) { return (Quadword)((U16x8)in.a + (U16x8)in.b); }
inline Quadword ahi(const In& in) { return (Quadword)((U16x8)in.a + splat_half(in.imm)); }
inline Quadword a(const In& in) { return in.a + in.b; }
inline Quadword ai(const In& in) { return in.a + splat_word(in.imm); }
inline Quadword sfh(const In& in) { return (Quadword)((U16x8)in.b - (U16x8)in.a); }
inline Quadword sfhi(const In& in) { return (Quadword)(splat_half(in.imm) - (U16x8)in.a); }
inline Quadword sf(const In& in) { return in.b - in.a; }
inline Quadword sfi(const In& in) { return splat_word(in.imm) - in.a; }

/// 1 where the mask of a comparison is set.
template <class Mask>
Quadword one_where(Mask mask) {
  return (Quadword)mask & splat_word(1);
}
inline Quadword carry_in(const In& in) { return in.t & splat_word(1); }

inline Quadword addx(const In& in) { return in.a + in.b + carry_in(in); }
inline Quadword sfx(const In& in) { return in.b + ~in.a + carry_in(in); }
inline Quadword cg(const In& in) { return one_where(in.a + in.b < in.a); }
inline Quadword cgx(const In& in) {
  const Quadword sum = in.a + in.b;
  return one_where((sum < in.a) | (sum + carry_in(in) < sum));
}
inline Quadword bg(const In& in) { return one_where(in.b >= in.a); }
inline Quadword bgx(const In& in) {
  const auto may_be_equal = (Quadword)(carry_in(in) != splat_word(0));
  return one_where((Quadword)(in.b > in.a) | ((Quadword)(in.b == in.a) & may_be_equal));
}

// ---- multiply: halves of words

inline Quadword low_signed(Quadword q) { return (Quadword)((S32x4)(q << 16) >> 16); }
inline Quadword high_signed(Quadword q) { return (Quadword)((S32x4)q >> 16); }
inline Quadword low_unsigned(Quadword q) { return q & splat_word(0xFFFF); }
inline Quadword high_unsigned(Quadword q) { return q >> 16; }

inline Quadword mpy(const In& in) { return low_signed(in.a) * low_signed(in.b); }
inline Quadword mpyu(const In& in) { return low_unsigned(in.a) * low_unsigned(in.b); }
inline Quadword mpyi(const In& in) { return low_signed(in.a) * splat_word(in.imm); }
inline Quadword mpyui(const In& in) { return low_unsigned(in.a) * splat_word(in.imm & 0xFFFF); }
inline Quadword mpya(const In& in) { return mpy(in) + in.c; }
inline Quadword mpyh(const In& in) { return (high_unsigned(in.a) * low_unsigned(in.b)) << 16; }
inline Quadword mpys(const In& in) { return high_signed(mpy(in)); }
inline Quadword mpyhh(const In& in) { return high_signed(in.a) * high_signed(in.b); }
inline Quadword mpyhha(const In& in) { return in.t + mpyhh(in); }
inline Quadword mpyhhu(const In& in) { return high_unsigned(in.a) * high_unsigned(in.b); }
inline Quadword mpyhhau(const In& in) { return in.t + mpyhhu(in); }

// ---- counts, bytes, sign extension

inline Quadword clz(const In& in) {
  Quadword result{};
  for (int i = 0; i < 4; ++i) {
    result[i] = in.a[i] == 0 ? 32u : static_cast<std::uint32_t>(__builtin_clz(in.a[i]));
  }
  return result;
}
inline Quadword cntb(const In& in) {
  const __m128i of_nibble = _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
  const __m128i low = (__m128i)((U8x16)in.a & splat_byte(0x0F));
  const __m128i high = (__m128i)((U8x16)in.a >> 4);
  return (Quadword)_mm_add_epi8(_mm_shuffle_epi8(of_nibble, low), _mm_shuffle_epi8(of_nibble, high));
}
inline Quadword avgb(const In& in) { return (Quadword)_mm_avg_epu8((__m128i)in.a, (__m128i)in.b); }
inline Quadword absdb(const In& in) {
  const __m128i x = (__m128i)in.a, y = (__m128i)in.b;
  return (Quadword)_mm_or_si128(_mm_subs_epu8(x, y), _mm_subs_epu8(y, x));
}
inline Quadword sum_of_bytes(Quadword q) {
  const __m128i of_two = _mm_maddubs_epi16((__m128i)q, (__m128i)splat_byte(1));
  return (Quadword)_mm_madd_epi16(of_two, (__m128i)splat_half(1));
}
inline Quadword sumb(const In& in) { return sum_of_bytes(in.b) << 16 | sum_of_bytes(in.a); }

inline Quadword xsbh(const In& in) { return (Quadword)((S16x8)((U16x8)in.a << 8) >> 8); }
inline Quadword xshw(const In& in) { return low_signed(in.a); }
inline Quadword xswd(const In& in) { return (Quadword)((S64x2)((U64x2)in.a << 32) >> 32); }

// ---- logic

inline Quadword and_(const In& in) { return in.a & in.b; }
inline Quadword andc(const In& in) { return in.a & ~in.b; }
inline Quadword andbi(const In& in) { return in.a & (Quadword)splat_byte(in.imm); }
inline Quadword andhi(const In& in) { return in.a & (Quadword)splat_half(in.imm); }
inline Quadword andi(const In& in) { return in.a & splat_word(in.imm); }
inline Quadword or_(const In& in) { return in.a | in.b; }
inline Quadword orc(const In& in) { return in.a | ~in.b; }
inline Quadword orbi(const In& in) { return in.a | (Quadword)splat_byte(in.imm); }
inline Quadword orhi(const In& in) { return in.a | (Quadword)splat_half(in.imm); }
inline Quadword ori(const In& in) { return in.a | splat_word(in.imm); }
inline Quadword xor_(const In& in) { return in.a ^ in.b; }
inline Quadword xorbi(const In& in) { return in.a ^ (Quadword)splat_byte(in.imm); }
inline Quadword xorhi(const In& in) { return in.a ^ (Quadword)splat_half(in.imm); }
inline Quadword xori(const In& in) { return in.a ^ splat_word(in.imm); }
inline Quadword nand(const In& in) { return ~(in.a & in.b); }
inline Quadword nor(const In& in) { return ~(in.a | in.b); }
inline Quadword eqv(const In& in) { return ~(in.a ^ in.b); }
inline Quadword selb(const In& in) { return (in.c & in.b) | (~in.c & in.a); }

// ---- compares: all ones where true

template <class V>
Quadword equal(V x, V y) {
  return (Quadword)(x == y);
}
template <class V>
Quadword greater(V x, V y) {
  return (Quadword)(x > y);
}

inline Quadword ceqb(const In& in) { return equal((U8x16)in.a, (U8x16)in.b); }
inline Quadword ceqbi(const In& in) { return equal((U8x16)in.a, splat_byte(in.imm)); }
inline Quadword ceqh(const In& in) { return equal((U16x8)in.a, (U16x8)in.b); }
inline Quadword ceqhi(const In& in) { return equal((U16x8)in.a, splat_half(in.imm)); }
inline Quadword ceq(const In& in) { return equal(in.a, in.b); }
inline Quadword ceqi(const In& in) { return equal(in.a, splat_word(in.imm)); }
inline Quadword cgtb(const In& in) { return greater((S8x16)in.a, (S8x16)in.b); }
inline Quadword cgtbi(const In& in) { return greater((S8x16)in.a, (S8x16)splat_byte(in.imm)); }
inline Quadword cgth(const In& in) { return greater((S16x8)in.a, (S16x8)in.b); }
inline Quadword cgthi(const In& in) { return greater((S16x8)in.a, (S16x8)splat_half(in.imm)); }
inline Quadword cgt(const In& in) { return greater((S32x4)in.a, (S32x4)in.b); }
inline Quadword cgti(const In& in) { return greater((S32x4)in.a, (S32x4)splat_word(in.imm)); }
inline Quadword clgtb(const In& in) { return greater((U8x16)in.a, (U8x16)in.b); }
inline Quadword clgtbi(const In& in) { return greater((U8x16)in.a, splat_byte(in.imm)); }
inline Quadword clgth(const In& in) { return greater((U16x8)in.a, (U16x8)in.b); }
inline Quadword clgthi(const In& in) { return greater((U16x8)in.a, splat_half(in.imm)); }
inline Quadword clgt(const In& in) { return greater(in.a, in.b); }
inline Quadword clgti(const In& in) { return greater(in.a, splat_word(in.imm)); }

/// Which SPRs the SPEs of a PS3 have is unconfirmed; each reads as zero.
inline Quadword mfspr(const In&) { return Quadword{}; }

}  // namespace softcell::ls_sim::interpreter::semantics
