#pragma once
// Shuffles, masks and gathers of bits. Each function is one instruction. [SPU-ISA] documented
#include "shift_semantics.h"

namespace softcell::ls_sim::interpreter::semantics {

/// The host's byte j is byte 15 - j of the SPU; a control byte selects byte c of RA or, from 16 on, of RB.
inline Quadword shufb(const In& in) {
  const auto control = (__m128i)in.c;
  const __m128i of_host = _mm_xor_si128(control, (__m128i)splat_byte(0x0F));
  const __m128i from_a = _mm_shuffle_epi8((__m128i)in.a, of_host);  // zero where the control is 1xxxxxxx
  const __m128i from_b = _mm_shuffle_epi8((__m128i)in.b, of_host);
  const __m128i wants_b = _mm_slli_epi16(control, 3);  // bit 0x10 of a byte becomes its uppermost one
  // By the upper four bits of the control: 10xx gives 00, 110x gives FF, 111x gives 80.
  const __m128i constants = _mm_setr_epi8(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1, -1, static_cast<char>(0x80),
                                          static_cast<char>(0x80));
  const __m128i upper = (__m128i)((U8x16)in.c >> 4);
  return (Quadword)_mm_or_si128(_mm_blendv_epi8(from_a, from_b, wants_b), _mm_shuffle_epi8(constants, upper));
}

// ---- controls for shufb that insert the preferred slot of RA into RB

/// @param bytes  1, 2, 4 or 8, to be put at `address` rounded down to a multiple of them. @param first  the
/// byte of the preferred slot where such an element begins.
inline Quadword insertion_control(std::uint32_t address, std::uint32_t bytes, std::uint32_t first) {
  // The host's byte j controls byte 15 - j, which copies byte 16 + 15 - j: that of RB.
  U8x16 control = 0x1F - host_positions();
  const std::uint32_t place = address & 15 & ~(bytes - 1);
  for (std::uint32_t i = 0; i < bytes; ++i) control[15 - (place + i)] = static_cast<std::uint8_t>(first + i);
  return (Quadword)control;
}
inline std::uint32_t place_by_immediate(const In& in) {
  return preferred_word(in.a) + static_cast<std::uint32_t>(in.imm);
}
inline std::uint32_t place_by_register(const In& in) { return preferred_word(in.a) + preferred_word(in.b); }

inline Quadword cbd(const In& in) { return insertion_control(place_by_immediate(in), 1, 3); }
inline Quadword chd(const In& in) { return insertion_control(place_by_immediate(in), 2, 2); }
inline Quadword cwd(const In& in) { return insertion_control(place_by_immediate(in), 4, 0); }
inline Quadword cdd(const In& in) { return insertion_control(place_by_immediate(in), 8, 0); }
inline Quadword cbx(const In& in) { return insertion_control(place_by_register(in), 1, 3); }
inline Quadword chx(const In& in) { return insertion_control(place_by_register(in), 2, 2); }
inline Quadword cwx(const In& in) { return insertion_control(place_by_register(in), 4, 0); }
inline Quadword cdx(const In& in) { return insertion_control(place_by_register(in), 8, 0); }

// ---- masks. The SPU's first element has the uppermost bit, so the host's element j has bit j.

inline Quadword mask_of_bytes(std::uint32_t bits) {
  const __m128i both = _mm_set1_epi16(static_cast<short>(bits));
  const __m128i byte_of_bits =
      _mm_shuffle_epi8(both, _mm_setr_epi8(0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1));
  const U8x16 bit{1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
  return (Quadword)(((U8x16)byte_of_bits & bit) == bit);
}
inline Quadword mask_of_halves(std::uint32_t bits) {
  const U16x8 bit{1, 2, 4, 8, 16, 32, 64, 128};
  return (Quadword)((splat_half(static_cast<std::int32_t>(bits)) & bit) == bit);
}
inline Quadword mask_of_words(std::uint32_t bits) {
  const U32x4 bit{1, 2, 4, 8};
  return (Quadword)((splat_word(static_cast<std::int32_t>(bits)) & bit) == bit);
}

inline Quadword fsmbi(const In& in) { return mask_of_bytes(static_cast<std::uint32_t>(in.imm)); }
inline Quadword fsmb(const In& in) { return mask_of_bytes(preferred_word(in.a)); }
inline Quadword fsmh(const In& in) { return mask_of_halves(preferred_word(in.a)); }
inline Quadword fsm(const In& in) { return mask_of_words(preferred_word(in.a)); }

// ---- gathers: the last bit of each element

inline Quadword gbb(const In& in) {
  return in_preferred_word(static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_slli_epi16((__m128i)in.a, 7))));
}
inline Quadword gbh(const In& in) {
  const __m128i signs = _mm_packs_epi16(_mm_slli_epi16((__m128i)in.a, 15), _mm_setzero_si128());
  return in_preferred_word(static_cast<std::uint32_t>(_mm_movemask_epi8(signs)));
}
inline Quadword gb(const In& in) {
  return in_preferred_word(static_cast<std::uint32_t>(_mm_movemask_ps((__m128)(in.a << 31))));
}
inline Quadword orx(const In& in) { return in_preferred_word(in.a[0] | in.a[1] | in.a[2] | in.a[3]); }

}  // namespace softcell::ls_sim::interpreter::semantics
