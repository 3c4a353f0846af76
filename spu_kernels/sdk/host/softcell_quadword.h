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
template <class T_>
SC_SDK_INLINE Vector<T_> take_bytes(Vector<T_> a_, Bytes pattern) {
  const Bytes outside = (Bytes)(pattern > 15);
  return make<Vector<T_>>(
      shuffle_bytes<sizeof(T_)>((Bytes)a_.raw, (Bytes)a_.raw, (pattern & ~outside) | (outside & 0x80)));
}

// By n = 0..31 bytes.
template <class T_>
SC_SDK_INLINE Vector<T_> bytes_left(Vector<T_> a_, unsigned int n_) {
  return take_bytes(a_, places() + static_cast<unsigned char>(n_));
}
template <class T_>
SC_SDK_INLINE Vector<T_> bytes_right(Vector<T_> a_, unsigned int n_) {
  return take_bytes(a_, places() - static_cast<unsigned char>(n_));
}
template <class T_>
SC_SDK_INLINE Vector<T_> bytes_around(Vector<T_> a_, unsigned int n_) {
  return take_bytes(a_, (places() + static_cast<unsigned char>(n_)) & 15);
}

// By n = 0..7 bits: each word, and what its neighbour gives it.
SC_SDK_INLINE __m128i words_left(__m128i a_, __m128i next, unsigned int n_) {
  return _mm_or_si128(_mm_sll_epi32(a_, _mm_cvtsi32_si128(static_cast<int>(n_))),
                      _mm_srl_epi32(next, _mm_cvtsi32_si128(static_cast<int>(32 - n_))));
}
template <class T_>
SC_SDK_INLINE Vector<T_> bits_left(Vector<T_> a_, unsigned int n_) {
  const __m128i words = bits(vec_uint4(a_));
  return Vector<T_>(make<vec_uint4>(words_left(words, _mm_srli_si128(words, 4), n_)));
}
template <class T_>
SC_SDK_INLINE Vector<T_> bits_around(Vector<T_> a_, unsigned int n_) {
  const __m128i words = bits(vec_uint4(a_));
  return Vector<T_>(make<vec_uint4>(words_left(words, _mm_shuffle_epi32(words, 0x39), n_)));
}
template <class T_>
SC_SDK_INLINE Vector<T_> bits_right(Vector<T_> a_, unsigned int n_) {
  const __m128i words = bits(vec_uint4(a_)), previous = _mm_slli_si128(words, 4);
  return Vector<T_>(
      make<vec_uint4>(_mm_or_si128(_mm_srl_epi32(words, _mm_cvtsi32_si128(static_cast<int>(n_))),
                                   _mm_sll_epi32(previous, _mm_cvtsi32_si128(static_cast<int>(32 - n_))))));
}

}  // namespace softcell_sdk

#define SC_SDK_QUADWORD(name, Count, operation, expression)                               \
  template <class T_>                                                                     \
  SC_SDK_INLINE softcell_sdk::Vector<T_> name(softcell_sdk::Vector<T_> a_, Count count) { \
    const unsigned int n_ = static_cast<unsigned int>(count);                             \
    return softcell_sdk::operation(a_, expression);                                       \
  }
SC_SDK_QUADWORD(spu_slqw, unsigned int, bits_left, n_ & 7u)
SC_SDK_QUADWORD(spu_slqwbyte, unsigned int, bytes_left, n_ & 31u)
SC_SDK_QUADWORD(spu_slqwbytebc, unsigned int, bytes_left, n_ >> 3 & 31u)
SC_SDK_QUADWORD(spu_rlqw, int, bits_around, n_ & 7u)
SC_SDK_QUADWORD(spu_rlqwbyte, int, bytes_around, n_ & 15u)
SC_SDK_QUADWORD(spu_rlqwbytebc, int, bytes_around, n_ >> 3 & 15u)
SC_SDK_QUADWORD(spu_rlmaskqw, int, bits_right, -n_ & 7u)
SC_SDK_QUADWORD(spu_rlmaskqwbyte, int, bytes_right, -n_ & 31u)
SC_SDK_QUADWORD(spu_rlmaskqwbytebc, int, bytes_right, -(n_ >> 3) & 31u)
SC_SDK_QUADWORD(spu_srqw, unsigned int, bits_right, n_ & 7u)
SC_SDK_QUADWORD(spu_srqwbyte, unsigned int, bytes_right, n_ & 31u)
SC_SDK_QUADWORD(spu_srqwbytebc, unsigned int, bytes_right, n_ >> 3 & 31u)
#undef SC_SDK_QUADWORD
