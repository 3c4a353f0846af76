#pragma once
// Integer arithmetic, and counting bits.  [LEXT, arithmetic and byte intrinsics; SPU-ISA] documented
//
// Halves of a word: "even" is the high one, lane 0, 2, .. of the halfwords; "odd" the low one. On the host
// the even half lies in the low 16 bits of a word's register lane.

#include "softcell_lanes.h"

// ---- add and subtract

template <class T, softcell_sdk::If<softcell_sdk::kHalfOrWord<T>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T> spu_add(softcell_sdk::Vector<T> a, softcell_sdk::Vector<T> b) {
  return softcell_sdk::make<softcell_sdk::Vector<T>>(softcell_sdk::wrap(a) + softcell_sdk::wrap(b));
}
template <class T, softcell_sdk::If<softcell_sdk::kHalfOrWord<T>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T> spu_add(softcell_sdk::Vector<T> a, softcell_sdk::Scalar<T> b) {
  return spu_add(a, softcell_sdk::splats<T>(b));
}
template <class T, softcell_sdk::If<softcell_sdk::kHalfOrWord<T>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T> spu_sub(softcell_sdk::Vector<T> a, softcell_sdk::Vector<T> b) {
  return softcell_sdk::make<softcell_sdk::Vector<T>>(softcell_sdk::wrap(a) - softcell_sdk::wrap(b));
}
/// The scalar minus each lane.
template <class T, softcell_sdk::If<softcell_sdk::kHalfOrWord<T>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T> spu_sub(softcell_sdk::Scalar<T> a, softcell_sdk::Vector<T> b) {
  return spu_sub(softcell_sdk::splats<T>(a), b);
}

// ---- carries and borrows of words; only the lowest bit of the third operand counts, and a borrow of 1 means
// "none needed"

#define SC_SDK_CARRY(name, parameters, operands, expression)            \
  template <class T, softcell_sdk::If<softcell_sdk::kWord<T>> = 0>      \
  SC_SDK_INLINE softcell_sdk::Vector<T> name parameters {               \
    using Words = softcell_sdk::Raw<unsigned int>;                      \
    const Words a = softcell_sdk::wrap(va), b = softcell_sdk::wrap(vb); \
    operands;                                                           \
    return softcell_sdk::make<softcell_sdk::Vector<T>>(expression);     \
  }
#define SC_SDK_TWO (softcell_sdk::Vector<T> va, softcell_sdk::Vector<T> vb)
#define SC_SDK_THREE (softcell_sdk::Vector<T> va, softcell_sdk::Vector<T> vb, softcell_sdk::Vector<T> vc)
#define SC_SDK_C const Words c = softcell_sdk::wrap(vc) & 1u

/// a + b + carry.
SC_SDK_CARRY(spu_addx, SC_SDK_THREE, SC_SDK_C, a + b + c)
/// a - b - (1 - carry).
SC_SDK_CARRY(spu_subx, SC_SDK_THREE, SC_SDK_C, a + ~b + c)
/// Carry out of a + b.
SC_SDK_CARRY(spu_genc, SC_SDK_TWO, const Words sum = a + b, Words(sum < a) & 1u)
/// Carry out of a + b + carry.
SC_SDK_CARRY(spu_gencx, SC_SDK_THREE, SC_SDK_C;
             const Words sum = a + b, (Words(sum < a) | Words(sum + c < sum)) & 1u)
/// 1 where a - b needs no borrow.
SC_SDK_CARRY(spu_genb, SC_SDK_TWO, , Words(a >= b) & 1u)
/// 1 where a - b - (1 - carry) needs no borrow.
SC_SDK_CARRY(spu_genbx, SC_SDK_THREE, SC_SDK_C, (Words(a > b) & 1u) | (Words(a == b) & c))

#undef SC_SDK_C
#undef SC_SDK_THREE
#undef SC_SDK_TWO
#undef SC_SDK_CARRY

// ---- multiply halves of 16 bits to words

namespace softcell_sdk {
SC_SDK_INLINE __m128i even_halves(__m128i a) { return _mm_and_si128(a, _mm_set1_epi32(0xFFFF)); }
SC_SDK_INLINE __m128i odd_halves(__m128i a) { return _mm_srli_epi32(a, 16); }
}  // namespace softcell_sdk

/// The odd halves multiplied.
SC_SDK_INLINE vec_int4 spu_mulo(vec_short8 a, vec_short8 b) {
  using namespace softcell_sdk;
  return make<vec_int4>(_mm_madd_epi16(odd_halves(bits(a)), odd_halves(bits(b))));
}
SC_SDK_INLINE vec_uint4 spu_mulo(vec_ushort8 a, vec_ushort8 b) {
  using namespace softcell_sdk;
  return make<vec_uint4>(_mm_mullo_epi32(odd_halves(bits(a)), odd_halves(bits(b))));
}
SC_SDK_INLINE vec_int4 spu_mulo(vec_short8 a, short b) { return spu_mulo(a, softcell_sdk::splats(b)); }
SC_SDK_INLINE vec_uint4 spu_mulo(vec_ushort8 a, unsigned short b) {
  return spu_mulo(a, softcell_sdk::splats(b));
}
/// The even halves multiplied.
SC_SDK_INLINE vec_int4 spu_mule(vec_short8 a, vec_short8 b) {
  using namespace softcell_sdk;
  return make<vec_int4>(_mm_madd_epi16(even_halves(bits(a)), even_halves(bits(b))));
}
SC_SDK_INLINE vec_uint4 spu_mule(vec_ushort8 a, vec_ushort8 b) {
  using namespace softcell_sdk;
  return make<vec_uint4>(_mm_mullo_epi32(even_halves(bits(a)), even_halves(bits(b))));
}
/// Even half of a times odd half of b, shifted up by 16: a cross term of a 32-bit product, which is
/// spu_mulh(a, b) + spu_mulh(b, a) + spu_mulo of both as unsigned.
SC_SDK_INLINE vec_int4 spu_mulh(vec_short8 a, vec_short8 b) {
  using namespace softcell_sdk;
  return make<vec_int4>(_mm_slli_epi32(_mm_mullo_epi16(bits(a), odd_halves(bits(b))), 16));
}
/// The odd halves multiplied, then shifted down by 16.
SC_SDK_INLINE vec_int4 spu_mulsr(vec_short8 a, vec_short8 b) {
  using namespace softcell_sdk;
  return make<vec_int4>(_mm_srai_epi32(_mm_mulhi_epi16(bits(a), bits(b)), 16));
}
/// The odd halves multiplied, plus c.
SC_SDK_INLINE vec_int4 spu_madd(vec_short8 a, vec_short8 b, vec_int4 c) { return spu_add(spu_mulo(a, b), c); }
/// The even halves multiplied, plus c.
SC_SDK_INLINE vec_int4 spu_mhhadd(vec_short8 a, vec_short8 b, vec_int4 c) {
  return spu_add(spu_mule(a, b), c);
}
SC_SDK_INLINE vec_uint4 spu_mhhadd(vec_ushort8 a, vec_ushort8 b, vec_uint4 c) {
  return spu_add(spu_mule(a, b), c);
}

// ---- bytes

SC_SDK_INLINE vec_uchar16 spu_absd(vec_uchar16 a, vec_uchar16 b) {
  using namespace softcell_sdk;
  return make<vec_uchar16>(_mm_or_si128(_mm_subs_epu8(bits(a), bits(b)), _mm_subs_epu8(bits(b), bits(a))));
}
/// The mean, rounded up.
SC_SDK_INLINE vec_uchar16 spu_avg(vec_uchar16 a, vec_uchar16 b) {
  using namespace softcell_sdk;
  return make<vec_uchar16>(_mm_avg_epu8(bits(a), bits(b)));
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
SC_SDK_INLINE vec_ushort8 spu_sumb(vec_uchar16 a, vec_uchar16 b) {
  using namespace softcell_sdk;
  return make<vec_ushort8>(_mm_or_si128(sums_of_bytes(bits(b)), _mm_slli_epi32(sums_of_bytes(bits(a)), 16)));
}

// ---- bits

/// Ones in each byte.
template <class T, softcell_sdk::If<sizeof(T) == 1> = 0>
SC_SDK_INLINE vec_uchar16 spu_cntb(softcell_sdk::Vector<T> a) {
  return softcell_sdk::make<vec_uchar16>(softcell_sdk::ones_in_bytes(softcell_sdk::bits(a)));
}
/// Leading zeros of each word, 32 for 0.
template <class T, softcell_sdk::If<sizeof(T) == 4> = 0>
SC_SDK_INLINE vec_uint4 spu_cntlz(softcell_sdk::Vector<T> a) {
  using namespace softcell_sdk;
  Raw<unsigned int> ones = wrap(a);  // after smearing: every bit below the first one
  ones |= ones >> 1;
  ones |= ones >> 2;
  ones |= ones >> 4;
  ones |= ones >> 8;
  ones |= ones >> 16;
  return make<vec_uint4>(32u - (Raw<unsigned int>)sums_of_bytes(ones_in_bytes((__m128i)ones)));
}

// ---- sign extension of the odd, low half of each lane

SC_SDK_INLINE vec_short8 spu_extend(vec_char16 a) {
  return softcell_sdk::make<vec_short8>(_mm_srai_epi16(softcell_sdk::bits(a), 8));
}
SC_SDK_INLINE vec_int4 spu_extend(vec_short8 a) {
  return softcell_sdk::make<vec_int4>(_mm_srai_epi32(softcell_sdk::bits(a), 16));
}
SC_SDK_INLINE vec_llong2 spu_extend(vec_int4 a) {
  const __m128i odd = _mm_shuffle_epi32(softcell_sdk::bits(a), 0xF5);
  return softcell_sdk::make<vec_llong2>(_mm_blend_epi32(odd, _mm_srai_epi32(odd, 31), 0xA));
}
