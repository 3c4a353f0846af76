#pragma once
// Shifts and rotates, of elements and of the whole quadword. Each function is one instruction. Right shifts
// take the negated count. [SPU-ISA, shift and rotate instructions] documented
#include "quadword.h"

namespace softcell::ls_sim::interpreter::semantics {

// ---- words. The host's shifts by element give zero, or the sign, for counts from 32 on.

inline Quadword shl_words(Quadword q, U32x4 counts) {
  return (Quadword)_mm_sllv_epi32((__m128i)q, (__m128i)(counts & 63));
}
inline Quadword shr_words(Quadword q, U32x4 counts) {
  return (Quadword)_mm_srlv_epi32((__m128i)q, (__m128i)(counts & 63));
}
inline Quadword sar_words(Quadword q, U32x4 counts) {
  return (Quadword)_mm_srav_epi32((__m128i)q, (__m128i)(counts & 63));
}
inline Quadword rot_words(Quadword q, U32x4 counts) {
  const U32x4 left = counts & 31;
  return (Quadword)_mm_or_si128(_mm_sllv_epi32((__m128i)q, (__m128i)left),
                                _mm_srlv_epi32((__m128i)q, (__m128i)(32 - left)));
}

inline Quadword shl(const In& in) { return shl_words(in.a, in.b); }
inline Quadword shli(const In& in) { return shl_words(in.a, splat_word(in.imm)); }
inline Quadword rot(const In& in) { return rot_words(in.a, in.b); }
inline Quadword roti(const In& in) { return rot_words(in.a, splat_word(in.imm)); }
inline Quadword rotm(const In& in) { return shr_words(in.a, -in.b); }
inline Quadword rotmi(const In& in) { return shr_words(in.a, splat_word(-in.imm)); }
inline Quadword rotma(const In& in) { return sar_words(in.a, -in.b); }
inline Quadword rotmai(const In& in) { return sar_words(in.a, splat_word(-in.imm)); }

// ---- halfwords, as words: the even ones and the odd ones

/// @param shift  of words, whose upper half is zero, by counts up to 31.
template <class Shift>
Quadword each_half(Quadword q, U16x8 counts, Shift&& shift) {
  const U32x4 n = (U32x4)counts, low_half = splat_word(0xFFFF);
  const Quadword low = shift(q & low_half, n & 31) & low_half;
  const Quadword high = shift(q >> 16, n >> 16 & 31) << 16;
  return low | high;
}

inline Quadword shl_halves(Quadword q, U16x8 counts) { return each_half(q, counts, shl_words); }
inline Quadword shr_halves(Quadword q, U16x8 counts) { return each_half(q, counts, shr_words); }
inline Quadword sar_halves(Quadword q, U16x8 counts) {
  return each_half(q, counts, [](Quadword half, U32x4 n) {
    return sar_words((Quadword)((S32x4)(half << 16) >> 16), n);  // counts from 16 on leave the sign
  });
}
inline Quadword rot_halves(Quadword q, U16x8 counts) {
  return each_half(q, counts,
                   [](Quadword half, U32x4 n) { return shl_words(half << 16 | half, n & 15) >> 16; });
}

inline Quadword shlh(const In& in) { return shl_halves(in.a, (U16x8)in.b); }
inline Quadword shlhi(const In& in) { return shl_halves(in.a, splat_half(in.imm)); }
inline Quadword roth(const In& in) { return rot_halves(in.a, (U16x8)in.b); }
inline Quadword rothi(const In& in) { return rot_halves(in.a, splat_half(in.imm)); }
inline Quadword rothm(const In& in) { return shr_halves(in.a, -(U16x8)in.b); }
inline Quadword rothmi(const In& in) { return shr_halves(in.a, splat_half(-in.imm)); }
inline Quadword rotmah(const In& in) { return sar_halves(in.a, -(U16x8)in.b); }
inline Quadword rotmahi(const In& in) { return sar_halves(in.a, splat_half(-in.imm)); }

// ---- the quadword, by bytes: the host's byte j comes from byte j - n or j + n

inline U8x16 host_positions() { return U8x16{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}; }

/// Bytes whose selector has its uppermost bit set become zero.
inline Quadword select_bytes(Quadword q, U8x16 selectors) {
  return (Quadword)_mm_shuffle_epi8((__m128i)q, (__m128i)selectors);
}
inline Quadword left_by_bytes(Quadword q, std::uint32_t count) {
  return select_bytes(q, host_positions() - splat_byte(count & 31));
}
inline Quadword right_by_bytes(Quadword q, std::uint32_t count) {
  constexpr int kPastTheEnd = 0x70;  // lifts a position from 16 on to 0x80 or more
  return select_bytes(q, host_positions() + splat_byte((count & 31) + kPastTheEnd));
}
inline Quadword rotate_bytes(Quadword q, std::uint32_t count) {
  return select_bytes(q, (host_positions() - splat_byte(count & 15)) & splat_byte(15));
}

// ---- the quadword, by up to 7 bits. The host's shifts by 64 give zero.

inline Quadword shifted_or(__m128i here, __m128i from_other_half) {
  return (Quadword)_mm_or_si128(here, from_other_half);
}
inline __m128i count_of(std::uint32_t bits) { return _mm_cvtsi32_si128(static_cast<int>(bits)); }

inline Quadword left_by_bits(Quadword q, std::uint32_t count) {
  const std::uint32_t n = count & 7;
  return shifted_or(_mm_sll_epi64((__m128i)q, count_of(n)),
                    _mm_srl_epi64(_mm_slli_si128((__m128i)q, 8), count_of(64 - n)));
}
inline Quadword right_by_bits(Quadword q, std::uint32_t count) {
  const std::uint32_t n = count & 7;
  return shifted_or(_mm_srl_epi64((__m128i)q, count_of(n)),
                    _mm_sll_epi64(_mm_srli_si128((__m128i)q, 8), count_of(64 - n)));
}
inline Quadword rotate_bits(Quadword q, std::uint32_t count) {
  const std::uint32_t n = count & 7;
  const __m128i halves_exchanged = _mm_shuffle_epi32((__m128i)q, 0x4E);
  return shifted_or(_mm_sll_epi64((__m128i)q, count_of(n)),
                    _mm_srl_epi64(halves_exchanged, count_of(64 - n)));
}

inline std::uint32_t count_in(const In& in) { return preferred_word(in.b); }
inline std::uint32_t count_in_immediate(const In& in) { return static_cast<std::uint32_t>(in.imm); }

inline Quadword shlqbi(const In& in) { return left_by_bits(in.a, count_in(in)); }
inline Quadword shlqbii(const In& in) { return left_by_bits(in.a, count_in_immediate(in)); }
inline Quadword shlqby(const In& in) { return left_by_bytes(in.a, count_in(in)); }
inline Quadword shlqbyi(const In& in) { return left_by_bytes(in.a, count_in_immediate(in)); }
inline Quadword shlqbybi(const In& in) { return left_by_bytes(in.a, count_in(in) >> 3); }
inline Quadword rotqby(const In& in) { return rotate_bytes(in.a, count_in(in)); }
inline Quadword rotqbyi(const In& in) { return rotate_bytes(in.a, count_in_immediate(in)); }
inline Quadword rotqbybi(const In& in) { return rotate_bytes(in.a, count_in(in) >> 3); }
inline Quadword rotqbi(const In& in) { return rotate_bits(in.a, count_in(in)); }
inline Quadword rotqbii(const In& in) { return rotate_bits(in.a, count_in_immediate(in)); }
inline Quadword rotqmby(const In& in) { return right_by_bytes(in.a, 0 - count_in(in)); }
inline Quadword rotqmbyi(const In& in) { return right_by_bytes(in.a, 0 - count_in_immediate(in)); }
inline Quadword rotqmbybi(const In& in) { return right_by_bytes(in.a, 0 - (count_in(in) >> 3)); }
inline Quadword rotqmbi(const In& in) { return right_by_bits(in.a, 0 - count_in(in)); }
inline Quadword rotqmbii(const In& in) { return right_by_bits(in.a, 0 - count_in_immediate(in)); }

}  // namespace softcell::ls_sim::interpreter::semantics
