#pragma once
// Shifts and rotates lane by lane, by a count for each lane or by one scalar.  [LEXT, shift and rotate;
// SPU-ISA] documented
//
// Counts are read modulo twice the lane's bits, so that "everything out" can be said: a word's count 32..63
// leaves nothing (or only sign). The rlmask forms take the count negated: spu_rlmask(a, -4) shifts right
// by 4.

#include "softcell_lanes.h"

namespace softcell_sdk {

template <class T_>
inline constexpr unsigned int kBits = 8 * sizeof(T_);
template <class T_>
inline constexpr unsigned int kCountMask = 2 * kBits<T_> - 1;

// By a count for each lane, 0..kCountMask. AVX2 has these for words; halfwords are worked in the words that
// hold two of them.

SC_SDK_INLINE __m128i in_even_halves(__m128i a_) { return _mm_and_si128(a_, _mm_set1_epi32(0xFFFF)); }
SC_SDK_INLINE __m128i in_odd_halves(__m128i a_) { return _mm_andnot_si128(_mm_set1_epi32(0xFFFF), a_); }
/// The counts of even and odd halves as counts of words.
SC_SDK_INLINE __m128i even_counts(__m128i n_) { return in_even_halves(n_); }
SC_SDK_INLINE __m128i odd_counts(__m128i n_) { return _mm_srli_epi32(n_, 16); }

template <class T_>
SC_SDK_INLINE __m128i shift_left(__m128i a_, __m128i n_) {
  if constexpr (sizeof(T_) == 4) return _mm_sllv_epi32(a_, n_);
  return _mm_or_si128(in_even_halves(_mm_sllv_epi32(in_even_halves(a_), even_counts(n_))),
                      _mm_sllv_epi32(in_odd_halves(a_), odd_counts(n_)));
}
template <class T_>
SC_SDK_INLINE __m128i shift_right(__m128i a_, __m128i n_) {
  if constexpr (sizeof(T_) == 4) return _mm_srlv_epi32(a_, n_);
  return _mm_or_si128(_mm_srlv_epi32(in_even_halves(a_), even_counts(n_)),
                      in_odd_halves(_mm_srlv_epi32(in_odd_halves(a_), odd_counts(n_))));
}
template <class T_>
SC_SDK_INLINE __m128i shift_right_signed(__m128i a_, __m128i n_) {
  if constexpr (sizeof(T_) == 4) return _mm_srav_epi32(a_, n_);
  const __m128i even = _mm_srai_epi32(_mm_slli_epi32(a_, 16), 16);
  return _mm_or_si128(in_even_halves(_mm_srav_epi32(even, even_counts(n_))),
                      in_odd_halves(_mm_srav_epi32(a_, odd_counts(n_))));
}

// By one scalar 0..kCountMask: written so that a constant becomes the instruction with an immediate.

template <class T_>
SC_SDK_INLINE Vector<T_> shift_left_by(Vector<T_> a_, unsigned int n_) {
  return n_ < kBits<T_> ? make<Vector<T_>>(wrap(a_) << static_cast<Unsigned<T_>>(n_)) : splats<T_>(0);
}
template <class T_>
SC_SDK_INLINE Vector<T_> shift_right_by(Vector<T_> a_, unsigned int n_) {
  return n_ < kBits<T_> ? make<Vector<T_>>(wrap(a_) >> static_cast<Unsigned<T_>>(n_)) : splats<T_>(0);
}
template <class T_>
SC_SDK_INLINE Vector<T_> shift_right_signed_by(Vector<T_> a_, unsigned int n_) {
  const unsigned int most = n_ < kBits<T_> ? n_ : kBits<T_> - 1;
  return make<Vector<T_>>((Raw<Signed<T_>>)a_.raw >> static_cast<Signed<T_>>(most));
}

}  // namespace softcell_sdk

// name, lane type of a vector of counts, type of a scalar count, the operation, the count it gets from
// `count`
#define SC_SDK_SHIFT(name, CountLane, CountScalar, operation, expression)                        \
  template <class T_, softcell_sdk::If<softcell_sdk::kHalfOrWord<T_>> = 0>                       \
  SC_SDK_INLINE softcell_sdk::Vector<T_> name(softcell_sdk::Vector<T_> a_,                       \
                                              softcell_sdk::Vector<CountLane<T_>> counts) {      \
    const auto count = softcell_sdk::wrap(counts);                                               \
    const auto mask = static_cast<softcell_sdk::Unsigned<T_>>(softcell_sdk::kCountMask<T_>);     \
    return softcell_sdk::make<softcell_sdk::Vector<T_>>(                                         \
        softcell_sdk::operation<T_>(softcell_sdk::bits(a_), (__m128i)((expression)&mask)));      \
  }                                                                                              \
  template <class T_, softcell_sdk::If<softcell_sdk::kHalfOrWord<T_>> = 0>                       \
  SC_SDK_INLINE softcell_sdk::Vector<T_> name(softcell_sdk::Vector<T_> a_, CountScalar scalar) { \
    const auto count = static_cast<unsigned int>(scalar);                                        \
    return softcell_sdk::operation##_by(a_, (expression)&softcell_sdk::kCountMask<T_>);          \
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
template <class T_, softcell_sdk::If<softcell_sdk::kHalfOrWord<T_>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T_> spu_rl(softcell_sdk::Vector<T_> a_,
                                              softcell_sdk::Vector<softcell_sdk::Signed<T_>> counts) {
  using namespace softcell_sdk;
  const auto count = wrap(counts) & static_cast<Unsigned<T_>>(kBits<T_> - 1);
  const auto rest = static_cast<Unsigned<T_>>(kBits<T_>) - count;  // a whole lane out for a count of 0
  return make<Vector<T_>>(
      _mm_or_si128(shift_left<T_>(bits(a_), (__m128i)count), shift_right<T_>(bits(a_), (__m128i)rest)));
}
template <class T_, softcell_sdk::If<softcell_sdk::kHalfOrWord<T_>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T_> spu_rl(softcell_sdk::Vector<T_> a_, int count) {
  using namespace softcell_sdk;
  const unsigned int left = static_cast<unsigned int>(count) & (kBits<T_> - 1);
  return make<Vector<T_>>(wrap(shift_left_by(a_, left)) | wrap(shift_right_by(a_, kBits<T_> - left)));
}
