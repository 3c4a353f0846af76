#pragma once
// A register of the SPU on the host.
//
// The SPU numbers the bytes of a quadword from its most significant end. A Quadword holds the 128 bits in the
// opposite order, as one little-endian number of the host, so that elements of every width are ordinary
// elements of the host and carries, shifts and halves fall where the host expects them:
//
//   SPU    byte 0  byte 1 ... byte 15     word w0  w1  w2  w3     doubleword d0  d1
//   host   [15]    [14]   ... [0]              [3] [2] [1] [0]               [1] [0]
//
// So element e of n is host element n - 1 - e, and the preferred slot is the last word of the host.

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

namespace softcell::ls_sim::interpreter {

/// Vectors of the compiler (GCC and Clang): + - * & | ^ ~ << >> and comparisons work on each element. A cast
/// from one to another keeps the bits.
using U8x16 = std::uint8_t __attribute__((vector_size(16)));
using S8x16 = std::int8_t __attribute__((vector_size(16)));
using U16x8 = std::uint16_t __attribute__((vector_size(16)));
using S16x8 = std::int16_t __attribute__((vector_size(16)));
using U32x4 = std::uint32_t __attribute__((vector_size(16)));
using S32x4 = std::int32_t __attribute__((vector_size(16)));
using U64x2 = std::uint64_t __attribute__((vector_size(16)));
using S64x2 = std::int64_t __attribute__((vector_size(16)));

using Quadword = U32x4;

inline constexpr int kPreferredWord = 3;  ///< of the host

inline std::uint32_t preferred_word(Quadword q) { return q[kPreferredWord]; }

/// A quadword with `value` in its preferred slot, and zeros.
inline Quadword in_preferred_word(std::uint32_t value) { return Quadword{0, 0, 0, value}; }

/// Words in the order of the SPU.
inline Quadword from_words(std::uint32_t w0, std::uint32_t w1, std::uint32_t w2, std::uint32_t w3) {
  return Quadword{w3, w2, w1, w0};
}
/// @param i  0..3, as the SPU counts.
inline std::uint32_t word(Quadword q, int i) { return q[3 - i]; }

/// A value in each element.
inline U8x16 splat_byte(std::int32_t value) { return (U8x16)_mm_set1_epi8(static_cast<char>(value)); }
inline U16x8 splat_half(std::int32_t value) { return (U16x8)_mm_set1_epi16(static_cast<short>(value)); }
inline U32x4 splat_word(std::int32_t value) { return (U32x4)_mm_set1_epi32(value); }

/// Between a quadword and its 16 bytes in a local store. `bytes` need not be aligned.
inline Quadword load_quadword(const std::byte* bytes) {
  const __m128i reversed = _mm_set_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  return (Quadword)_mm_shuffle_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes)), reversed);
}
inline void store_quadword(std::byte* bytes, Quadword q) {
  const __m128i reversed = _mm_set_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(bytes), _mm_shuffle_epi8((__m128i)q, reversed));
}

/// The operands of an instruction that computes its target from registers.
struct In {
  Quadword a, b, c, t;  ///< registers RA, RB, RC, RT, as they are before the instruction
  std::int32_t imm;     ///< Operation::imm
};

}  // namespace softcell::ls_sim::interpreter
