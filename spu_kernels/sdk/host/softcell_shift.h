#pragma once
// Shifts and rotates lane by lane, by a count for each lane or by one scalar.  [LEXT, shift and rotate;
// SPU-ISA] documented
//
// Counts are read modulo twice the lane's bits, so that "everything out" can be said: a word's count 32..63
// leaves nothing (or only sign). The rlmask forms take the count negated: spu_rlmask(a, -4) shifts right
// by 4.

#include "softcell_lanes.h"

namespace softcell_sdk {

template <class T>
inline constexpr unsigned int kBits = 8 * sizeof(T);
template <class T>
inline constexpr unsigned int kCountMask = 2 * kBits<T> - 1;

// By a count for each lane, 0..kCountMask. AVX2 has these for words; halfwords are worked in the words that
// hold two of them.

SC_SDK_INLINE __m128i in_even_halves(__m128i a) { return _mm_and_si128(a, _mm_set1_epi32(0xFFFF)); }
SC_SDK_INLINE __m128i in_odd_halves(__m128i a) { return _mm_andnot_si128(_mm_set1_epi32(0xFFFF), a); }
/// The counts of even and odd halves as counts of words.
SC_SDK_INLINE __m128i even_counts(__m128i n) { return in_even_halves(n); }
SC_SDK_INLINE __m128i odd_counts(__m128i n) { return _mm_srli_epi32(n, 16); }

template <class T>
SC_SDK_INLINE __m128i shift_left(__m128i a, __m128i n) {
  if constexpr (sizeof(T) == 4) return _mm_sllv_epi32(a, n);
  return _mm_or_si128(in_even_halves(_mm_sllv_epi32(in_even_halves(a), even_counts(n))),
                      _mm_sllv_epi32(in_odd_halves(a), odd_counts(n)));
}
template <class T>
SC_SDK_INLINE __m128i shift_right(__m128i a, __m128i n) {
  if constexpr (sizeof(T) == 4) return _mm_srlv_epi32(a, n);
  return _mm_or_si128(_mm_srlv_epi32(in_even_halves(a), even_counts(n)),
                      in_odd_halves(_mm_srlv_epi32(in_odd_halves(a), odd_counts(n))));
}
template <class T>
SC_SDK_INLINE __m128i shift_right_signed(__m128i a, __m128i n) {
  if constexpr (sizeof(T) == 4) return _mm_srav_epi32(a, n);
  const __m128i even = _mm_srai_epi32(_mm_slli_epi32(a, 16), 16);
  return _mm_or_si128(in_even_halves(_mm_srav_epi32(even, even_counts(n))),
                      in_odd_halves(_mm_srav_epi32(a, odd_counts(n))));
}

// By one scalar 0..kCountMask: written so that a constant becomes the instruction with an immediate.

template <class T>
SC_SDK_INLINE Vector<T> shift_left_by(Vector<T> a, unsigned int n) {
  return n < kBits<T> ? make<Vector<T>>(wrap(a) << static_cast<Unsigned<T>>(n)) : splats<T>(0);
}
template <class T>
SC_SDK_INLINE Vector<T> shift_right_by(Vector<T> a, unsigned int n) {
  return n < kBits<T> ? make<Vector<T>>(wrap(a) >> static_cast<Unsigned<T>>(n)) : splats<T>(0);
}
template <class T>
SC_SDK_INLINE Vector<T> shift_right_signed_by(Vector<T> a, unsigned int n) {
  const unsigned int most = n < kBits<T> ? n : kBits<T> - 1;
  return make<Vector<T>>((Raw<Signed<T>>)a.raw >> static_cast<Signed<T>>(most));
}

}  // namespace softcell_sdk

// name, lane type of a vector of counts, type of a scalar count, the operation, the count it gets from
// `count`
#define SC_SDK_SHIFT(name, CountLane, CountScalar, operation, expression)                     \
  template <class T, softcell_sdk::If<softcell_sdk::kHalfOrWord<T>> = 0>                      \
  SC_SDK_INLINE softcell_sdk::Vector<T> name(softcell_sdk::Vector<T> a,                       \
                                             softcell_sdk::Vector<CountLane<T>> counts) {     \
    const auto count = softcell_sdk::wrap(counts);                                            \
    const auto mask = static_cast<softcell_sdk::Unsigned<T>>(softcell_sdk::kCountMask<T>);    \
    return softcell_sdk::make<softcell_sdk::Vector<T>>(                                       \
        softcell_sdk::operation<T>(softcell_sdk::bits(a), (__m128i)((expression)&mask)));     \
  }                                                                                           \
  template <class T, softcell_sdk::If<softcell_sdk::kHalfOrWord<T>> = 0>                      \
  SC_SDK_INLINE softcell_sdk::Vector<T> name(softcell_sdk::Vector<T> a, CountScalar scalar) { \
    const auto count = static_cast<unsigned int>(scalar);                                     \
    return softcell_sdk::operation##_by(a, (expression)&softcell_sdk::kCountMask<T>);         \
  }

/// a << count.
SC_SDK_SHIFT(spu_sl, softcell_sdk::Unsigned, unsigned int, shift_left, count)
/// a >> -count, zeros coming in.
SC_SDK_SHIFT(spu_rlmask, softcell_sdk::Signed, int, shift_right, -count)
/// a >> -count, the sign coming in, whatever the type.
SC_SDK_SHIFT(spu_rlmaska, softcell_sdk::Signed, int, shift_right_signed, -count)
/// a >> count, zeros coming in.
SC_SDK_SHIFT(spu_sr, softcell_sdk::Unsigned, unsigned int, shift_right, count)
/// a >> count, the sign coming in, whatever the type.
SC_SDK_SHIFT(spu_sra, softcell_sdk::Unsigned, unsigned int, shift_right_signed, count)
#undef SC_SDK_SHIFT

/// Rotates left; counts are read modulo the lane's bits.
template <class T, softcell_sdk::If<softcell_sdk::kHalfOrWord<T>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T> spu_rl(softcell_sdk::Vector<T> a,
                                             softcell_sdk::Vector<softcell_sdk::Signed<T>> counts) {
  using namespace softcell_sdk;
  const auto count = wrap(counts) & static_cast<Unsigned<T>>(kBits<T> - 1);
  const auto rest = static_cast<Unsigned<T>>(kBits<T>) - count;  // a whole lane out for a count of 0
  return make<Vector<T>>(
      _mm_or_si128(shift_left<T>(bits(a), (__m128i)count), shift_right<T>(bits(a), (__m128i)rest)));
}
template <class T, softcell_sdk::If<softcell_sdk::kHalfOrWord<T>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T> spu_rl(softcell_sdk::Vector<T> a, int count) {
  using namespace softcell_sdk;
  const unsigned int left = static_cast<unsigned int>(count) & (kBits<T> - 1);
  return make<Vector<T>>(wrap(shift_left_by(a, left)) | wrap(shift_right_by(a, kBits<T> - left)));
}
