#pragma once
// Integer arithmetic, and counting bits.  [LEXT, arithmetic and byte intrinsics; SPU-ISA] documented
//
// Halves of a word: "even" is the high one, lane 0, 2, .. of the halfwords; "odd" the low one. On the host
// the even half lies in the low 16 bits of a word's register lane.

#include "softcell_lanes.h"

// ---- add and subtract

template <class T_, softcell_sdk::If<softcell_sdk::kHalfOrWord<T_>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T_> spu_add(softcell_sdk::Vector<T_> a_, softcell_sdk::Vector<T_> b_) {
  return softcell_sdk::make<softcell_sdk::Vector<T_>>(softcell_sdk::wrap(a_) + softcell_sdk::wrap(b_));
}
template <class T_, softcell_sdk::If<softcell_sdk::kHalfOrWord<T_>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T_> spu_add(softcell_sdk::Vector<T_> a_, softcell_sdk::Scalar<T_> b_) {
  return spu_add(a_, softcell_sdk::splats<T_>(b_));
}
template <class T_, softcell_sdk::If<softcell_sdk::kHalfOrWord<T_>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T_> spu_sub(softcell_sdk::Vector<T_> a_, softcell_sdk::Vector<T_> b_) {
  return softcell_sdk::make<softcell_sdk::Vector<T_>>(softcell_sdk::wrap(a_) - softcell_sdk::wrap(b_));
}
/// The scalar minus each lane.
template <class T_, softcell_sdk::If<softcell_sdk::kHalfOrWord<T_>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T_> spu_sub(softcell_sdk::Scalar<T_> a_, softcell_sdk::Vector<T_> b_) {
  return spu_sub(softcell_sdk::splats<T_>(a_), b_);
}

// ---- carries and borrows of words; only the lowest bit of the third operand counts, and a borrow of 1 means
// "none needed"

#define SC_SDK_CARRY(name, parameters, operands, expression)              \
  template <class T_, softcell_sdk::If<softcell_sdk::kWord<T_>> = 0>      \
  SC_SDK_INLINE softcell_sdk::Vector<T_> name parameters {                \
    using Words = softcell_sdk::Raw<unsigned int>;                        \
    const Words a_ = softcell_sdk::wrap(va), b_ = softcell_sdk::wrap(vb); \
    operands;                                                             \
    return softcell_sdk::make<softcell_sdk::Vector<T_>>(expression);      \
  }
#define SC_SDK_TWO (softcell_sdk::Vector<T_> va, softcell_sdk::Vector<T_> vb)
#define SC_SDK_THREE (softcell_sdk::Vector<T_> va, softcell_sdk::Vector<T_> vb, softcell_sdk::Vector<T_> vc)
#define SC_SDK_C const Words c_ = softcell_sdk::wrap(vc) & 1u

/// a + b + carry.
SC_SDK_CARRY(spu_addx, SC_SDK_THREE, SC_SDK_C, a_ + b_ + c_)
/// a - b - (1 - carry).
SC_SDK_CARRY(spu_subx, SC_SDK_THREE, SC_SDK_C, a_ + ~b_ + c_)
/// Carry out of a + b.
SC_SDK_CARRY(spu_genc, SC_SDK_TWO, const Words sum = a_ + b_, Words(sum < a_) & 1u)
/// Carry out of a + b + carry.
SC_SDK_CARRY(spu_gencx, SC_SDK_THREE, SC_SDK_C;
             const Words sum = a_ + b_, (Words(sum < a_) | Words(sum + c_ < sum)) & 1u)
/// 1 where a - b needs no borrow.
SC_SDK_CARRY(spu_genb, SC_SDK_TWO, , Words(a_ >= b_) & 1u)
/// 1 where a - b - (1 - carry) needs no borrow.
SC_SDK_CARRY(spu_genbx, SC_SDK_THREE, SC_SDK_C, (Words(a_ > b_) & 1u) | (Words(a_ == b_) & c_))

#undef SC_SDK_C
#undef SC_SDK_THREE
#undef SC_SDK_TWO
#undef SC_SDK_CARRY

// ---- multiply halves of 16 bits to words

namespace softcell_sdk {
SC_SDK_INLINE __m128i even_halves(__m128i a_) { return _mm_and_si128(a_, _mm_set1_epi32(0xFFFF)); }
SC_SDK_INLINE __m128i odd_halves(__m128i a_) { return _mm_srli_epi32(a_, 16); }
}  // namespace softcell_sdk

/// The odd halves multiplied.
SC_SDK_INLINE vec_int4 spu_mulo(vec_short8 a_, vec_short8 b_) {
  using namespace softcell_sdk;
  return make<vec_int4>(_mm_madd_epi16(odd_halves(bits(a_)), odd_halves(bits(b_))));
}
SC_SDK_INLINE vec_uint4 spu_mulo(vec_ushort8 a_, vec_ushort8 b_) {
  using namespace softcell_sdk;
  return make<vec_uint4>(_mm_mullo_epi32(odd_halves(bits(a_)), odd_halves(bits(b_))));
}
SC_SDK_INLINE vec_int4 spu_mulo(vec_short8 a_, short b_) { return spu_mulo(a_, softcell_sdk::splats(b_)); }
SC_SDK_INLINE vec_uint4 spu_mulo(vec_ushort8 a_, unsigned short b_) {
  return spu_mulo(a_, softcell_sdk::splats(b_));
}
/// The even halves multiplied.
SC_SDK_INLINE vec_int4 spu_mule(vec_short8 a_, vec_short8 b_) {
  using namespace softcell_sdk;
  return make<vec_int4>(_mm_madd_epi16(even_halves(bits(a_)), even_halves(bits(b_))));
}
SC_SDK_INLINE vec_uint4 spu_mule(vec_ushort8 a_, vec_ushort8 b_) {
  using namespace softcell_sdk;
  return make<vec_uint4>(_mm_mullo_epi32(even_halves(bits(a_)), even_halves(bits(b_))));
}
/// Even half of a times odd half of b, shifted up by 16: a cross term of a 32-bit product, which is
/// spu_mulh(a, b) + spu_mulh(b, a) + spu_mulo of both as unsigned.
SC_SDK_INLINE vec_int4 spu_mulh(vec_short8 a_, vec_short8 b_) {
  using namespace softcell_sdk;
  return make<vec_int4>(_mm_slli_epi32(_mm_mullo_epi16(bits(a_), odd_halves(bits(b_))), 16));
}
/// The odd halves multiplied, then shifted down by 16.
SC_SDK_INLINE vec_int4 spu_mulsr(vec_short8 a_, vec_short8 b_) {
  using namespace softcell_sdk;
  return make<vec_int4>(_mm_srai_epi32(_mm_mulhi_epi16(bits(a_), bits(b_)), 16));
}
/// The odd halves multiplied, plus c.
SC_SDK_INLINE vec_int4 spu_madd(vec_short8 a_, vec_short8 b_, vec_int4 c_) {
  return spu_add(spu_mulo(a_, b_), c_);
}
/// The even halves multiplied, plus c.
SC_SDK_INLINE vec_int4 spu_mhhadd(vec_short8 a_, vec_short8 b_, vec_int4 c_) {
  return spu_add(spu_mule(a_, b_), c_);
}
SC_SDK_INLINE vec_uint4 spu_mhhadd(vec_ushort8 a_, vec_ushort8 b_, vec_uint4 c_) {
  return spu_add(spu_mule(a_, b_), c_);
}

// ---- bytes

SC_SDK_INLINE vec_uchar16 spu_absd(vec_uchar16 a_, vec_uchar16 b_) {
  using namespace softcell_sdk;
  return make<vec_uchar16>(
      _mm_or_si128(_mm_subs_epu8(bits(a_), bits(b_)), _mm_subs_epu8(bits(b_), bits(a_))));
}
/// The mean, rounded up.
SC_SDK_INLINE vec_uchar16 spu_avg(vec_uchar16 a_, vec_uchar16 b_) {
  using namespace softcell_sdk;
  return make<vec_uchar16>(_mm_avg_epu8(bits(a_), bits(b_)));
}

namespace softcell_sdk {

/// Each word: the sum of its four bytes.
SC_SDK_INLINE __m128i sums_of_bytes(__m128i bytes) {
  return _mm_madd_epi16(_mm_maddubs_epi16(bytes, _mm_set1_epi8(1)), _mm_set1_epi16(1));
}

SC_SDK_INLINE __m128i ones_in_bytes(__m128i bytes) {
  const __m128i ones = _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4),
                nibble = _mm_set1_epi8(15);
  const __m128i low = _mm_shuffle_epi8(ones, _mm_and_si128(bytes, nibble));
  const __m128i high = _mm_shuffle_epi8(ones, _mm_and_si128(_mm_srli_epi16(bytes, 4), nibble));
  return _mm_add_epi8(low, high);
}

}  // namespace softcell_sdk

/// In each word: the four bytes of b summed in the even half, those of a in the odd one.
SC_SDK_INLINE vec_ushort8 spu_sumb(vec_uchar16 a_, vec_uchar16 b_) {
  using namespace softcell_sdk;
  return make<vec_ushort8>(
      _mm_or_si128(sums_of_bytes(bits(b_)), _mm_slli_epi32(sums_of_bytes(bits(a_)), 16)));
}

// ---- bits

/// Ones in each byte.
template <class T_, softcell_sdk::If<sizeof(T_) == 1> = 0>
SC_SDK_INLINE vec_uchar16 spu_cntb(softcell_sdk::Vector<T_> a_) {
  return softcell_sdk::make<vec_uchar16>(softcell_sdk::ones_in_bytes(softcell_sdk::bits(a_)));
}
/// Leading zeros of each word, 32 for 0.
template <class T_, softcell_sdk::If<sizeof(T_) == 4> = 0>
SC_SDK_INLINE vec_uint4 spu_cntlz(softcell_sdk::Vector<T_> a_) {
  using namespace softcell_sdk;
  Raw<unsigned int> ones = wrap(a_);  // after smearing: every bit below the first one
  ones |= ones >> 1;
  ones |= ones >> 2;
  ones |= ones >> 4;
  ones |= ones >> 8;
  ones |= ones >> 16;
  return make<vec_uint4>(32u - (Raw<unsigned int>)sums_of_bytes(ones_in_bytes((__m128i)ones)));
}

// ---- sign extension of the odd, low half of each lane

SC_SDK_INLINE vec_short8 spu_extend(vec_char16 a_) {
  return softcell_sdk::make<vec_short8>(_mm_srai_epi16(softcell_sdk::bits(a_), 8));
}
SC_SDK_INLINE vec_int4 spu_extend(vec_short8 a_) {
  return softcell_sdk::make<vec_int4>(_mm_srai_epi32(softcell_sdk::bits(a_), 16));
}
SC_SDK_INLINE vec_llong2 spu_extend(vec_int4 a_) {
  const __m128i odd = _mm_shuffle_epi32(softcell_sdk::bits(a_), 0xF5);
  return softcell_sdk::make<vec_llong2>(_mm_blend_epi32(odd, _mm_srai_epi32(odd, 31), 0xA));
}
