#pragma once
// Shifts and rotates of the register as one number of 128 bits, byte 0 the most significant.  [LEXT; SPU-ISA]
// documented
//
// ..qw: by 0..7 bits. ..qwbyte: by bytes. ..qwbytebc: by bytes, the count given in bits. The rlmask forms
// shift right by the negated count, the sr forms by the count itself.

#include "softcell_shuffle.h"

namespace softcell_sdk {

SC_SDK_INLINE Bytes places() { return Bytes{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}; }

/// Shuffles one register; zero where the pattern is not 0..15.
template <class T>
SC_SDK_INLINE Vector<T> take_bytes(Vector<T> a, Bytes pattern) {
  const Bytes outside = (Bytes)(pattern > 15);
  return make<Vector<T>>(
      shuffle_bytes<sizeof(T)>((Bytes)a.raw, (Bytes)a.raw, (pattern & ~outside) | (outside & 0x80)));
}

// By n = 0..31 bytes.
template <class T>
SC_SDK_INLINE Vector<T> bytes_left(Vector<T> a, unsigned int n) {
  return take_bytes(a, places() + static_cast<unsigned char>(n));
}
template <class T>
SC_SDK_INLINE Vector<T> bytes_right(Vector<T> a, unsigned int n) {
  return take_bytes(a, places() - static_cast<unsigned char>(n));
}
template <class T>
SC_SDK_INLINE Vector<T> bytes_around(Vector<T> a, unsigned int n) {
  return take_bytes(a, (places() + static_cast<unsigned char>(n)) & 15);
}

// By n = 0..7 bits: each word, and what its neighbour gives it.
SC_SDK_INLINE __m128i words_left(__m128i a, __m128i next, unsigned int n) {
  return _mm_or_si128(_mm_sll_epi32(a, _mm_cvtsi32_si128(static_cast<int>(n))),
                      _mm_srl_epi32(next, _mm_cvtsi32_si128(static_cast<int>(32 - n))));
}
template <class T>
SC_SDK_INLINE Vector<T> bits_left(Vector<T> a, unsigned int n) {
  const __m128i words = bits(vec_uint4(a));
  return Vector<T>(make<vec_uint4>(words_left(words, _mm_srli_si128(words, 4), n)));
}
template <class T>
SC_SDK_INLINE Vector<T> bits_around(Vector<T> a, unsigned int n) {
  const __m128i words = bits(vec_uint4(a));
  return Vector<T>(make<vec_uint4>(words_left(words, _mm_shuffle_epi32(words, 0x39), n)));
}
template <class T>
SC_SDK_INLINE Vector<T> bits_right(Vector<T> a, unsigned int n) {
  const __m128i words = bits(vec_uint4(a)), previous = _mm_slli_si128(words, 4);
  return Vector<T>(
      make<vec_uint4>(_mm_or_si128(_mm_srl_epi32(words, _mm_cvtsi32_si128(static_cast<int>(n))),
                                   _mm_sll_epi32(previous, _mm_cvtsi32_si128(static_cast<int>(32 - n))))));
}

}  // namespace softcell_sdk

#define SC_SDK_QUADWORD(name, Count, operation, expression)                            \
  template <class T>                                                                   \
  SC_SDK_INLINE softcell_sdk::Vector<T> name(softcell_sdk::Vector<T> a, Count count) { \
    const unsigned int n = static_cast<unsigned int>(count);                           \
    return softcell_sdk::operation(a, expression);                                     \
  }
SC_SDK_QUADWORD(spu_slqw, unsigned int, bits_left, n & 7u)
SC_SDK_QUADWORD(spu_slqwbyte, unsigned int, bytes_left, n & 31u)
SC_SDK_QUADWORD(spu_slqwbytebc, unsigned int, bytes_left, n >> 3 & 31u)
SC_SDK_QUADWORD(spu_rlqw, int, bits_around, n & 7u)
SC_SDK_QUADWORD(spu_rlqwbyte, int, bytes_around, n & 15u)
SC_SDK_QUADWORD(spu_rlqwbytebc, int, bytes_around, n >> 3 & 15u)
SC_SDK_QUADWORD(spu_rlmaskqw, int, bits_right, -n & 7u)
SC_SDK_QUADWORD(spu_rlmaskqwbyte, int, bytes_right, -n & 31u)
SC_SDK_QUADWORD(spu_rlmaskqwbytebc, int, bytes_right, -(n >> 3) & 31u)
SC_SDK_QUADWORD(spu_srqw, unsigned int, bits_right, n & 7u)
SC_SDK_QUADWORD(spu_srqwbyte, unsigned int, bytes_right, n & 31u)
SC_SDK_QUADWORD(spu_srqwbytebc, unsigned int, bytes_right, n >> 3 & 31u)
#undef SC_SDK_QUADWORD
