#pragma once
// Bits, selection, shuffles, compares of integers, and moving lanes about. [LEXT, generic intrinsics] documented

#include "softcell_vectors.h"

// ---- splat, extract, insert, promote

#define SC_SDK_SPLATS(Scalar, Name)                       \
  inline Name spu_splats(Scalar value) {                  \
    Name result;                                          \
    for (int i = 0; i < Name::kLanes; ++i) {              \
      result.raw[i] = static_cast<Name::Lane>(value);     \
    }                                                     \
    return result;                                        \
  }
SC_SDK_SPLATS(unsigned char, vec_uchar16)
SC_SDK_SPLATS(signed char, vec_char16)
SC_SDK_SPLATS(unsigned short, vec_ushort8)
SC_SDK_SPLATS(signed short, vec_short8)
SC_SDK_SPLATS(unsigned int, vec_uint4)
SC_SDK_SPLATS(signed int, vec_int4)
SC_SDK_SPLATS(unsigned long, vec_ullong2)  // the host's uint64_t; on the SPU a long has 32 bits
SC_SDK_SPLATS(signed long, vec_llong2)
SC_SDK_SPLATS(unsigned long long, vec_ullong2)
SC_SDK_SPLATS(signed long long, vec_llong2)
SC_SDK_SPLATS(float, vec_float4)
SC_SDK_SPLATS(double, vec_double2)
#undef SC_SDK_SPLATS

/// Lane `element` modulo the number of lanes.
template <class V, softcell_sdk::If<softcell_sdk::kVector<V>> = 0>
inline typename V::Lane spu_extract(const V& a, int element) {
  return a.raw[element & (V::kLanes - 1)];
}

template <class V, softcell_sdk::If<softcell_sdk::kVector<V>> = 0>
inline V spu_insert(typename V::Lane scalar, V a, int element) {
  a.raw[element & (V::kLanes - 1)] = scalar;
  return a;
}

/// The scalar in lane `element`; the other lanes, which the SPU leaves undefined, hold it too.
#define SC_SDK_PROMOTE(Scalar) \
  inline auto spu_promote(Scalar scalar, int) { return spu_splats(scalar); }
SC_SDK_PROMOTE(unsigned char)
SC_SDK_PROMOTE(signed char)
SC_SDK_PROMOTE(unsigned short)
SC_SDK_PROMOTE(signed short)
SC_SDK_PROMOTE(unsigned int)
SC_SDK_PROMOTE(signed int)
SC_SDK_PROMOTE(unsigned long)
SC_SDK_PROMOTE(signed long)
SC_SDK_PROMOTE(unsigned long long)
SC_SDK_PROMOTE(signed long long)
SC_SDK_PROMOTE(float)
SC_SDK_PROMOTE(double)
#undef SC_SDK_PROMOTE

// ---- logic: on the bits of any type, floats included; integers also with a scalar on the right

#define SC_SDK_LOGIC(name, expression)                                                                      \
  template <class V, softcell_sdk::If<softcell_sdk::kVector<V>> = 0>                                        \
  inline V name(const V& va, const V& vb) {                                                                 \
    const softcell_sdk::Pair a = (softcell_sdk::Pair)va.raw, b = (softcell_sdk::Pair)vb.raw;                \
    return V::from_raw((softcell_sdk::Raw<typename V::Lane>)(expression));                                  \
  }
SC_SDK_LOGIC(spu_and, a & b)
SC_SDK_LOGIC(spu_andc, a & ~b)
SC_SDK_LOGIC(spu_eqv, ~(a ^ b))
SC_SDK_LOGIC(spu_nand, ~(a & b))
SC_SDK_LOGIC(spu_nor, ~(a | b))
SC_SDK_LOGIC(spu_or, a | b)
SC_SDK_LOGIC(spu_orc, a | ~b)
SC_SDK_LOGIC(spu_xor, a ^ b)
#undef SC_SDK_LOGIC

#define SC_SDK_LOGIC_SCALAR(name)                                                        \
  template <class V, softcell_sdk::If<softcell_sdk::kInteger<V> && V::kWidth <= 4> = 0>  \
  inline V name(const V& a, typename V::Lane b) {                                        \
    return name(a, spu_splats(b));                                                       \
  }
SC_SDK_LOGIC_SCALAR(spu_and)
SC_SDK_LOGIC_SCALAR(spu_or)
SC_SDK_LOGIC_SCALAR(spu_xor)
#undef SC_SDK_LOGIC_SCALAR

/// b where the mask has ones, a where it has zeros, bit by bit; the mask has unsigned lanes of the same width.
template <class V, softcell_sdk::If<softcell_sdk::kVector<V>> = 0>
inline V spu_sel(const V& a, const V& b, const softcell_sdk::UnsignedOf<V>& mask) {
  const softcell_sdk::Pair m = (softcell_sdk::Pair)mask.raw;
  return V::from_raw((softcell_sdk::Raw<typename V::Lane>)(((softcell_sdk::Pair)b.raw & m) | ((softcell_sdk::Pair)a.raw & ~m)));
}

/// All four words of `a` or-ed into word 0; the others are 0.
template <class V, softcell_sdk::If<softcell_sdk::kInteger<V> || softcell_sdk::kSame<V, vec_float4> || softcell_sdk::kSame<V, vec_double2>> = 0>
inline V spu_orx(const V& a) {
  const vec_uint4 words(a);
  const vec_uint4 sum(words.raw[0] | words.raw[1] | words.raw[2] | words.raw[3], 0u, 0u, 0u);
  return V(sum);
}

// ---- shuffle

namespace softcell_sdk {

/// True when the optimiser knows that no bit of `mask` is set.
#define SC_SDK_KNOWN_ZERO(mask)                                                                \
  (__builtin_constant_p(((softcell_sdk::Pair)(mask))[0] | ((softcell_sdk::Pair)(mask))[1]) &&    \
   (((softcell_sdk::Pair)(mask))[0] | ((softcell_sdk::Pair)(mask))[1]) == 0)

/// The byte select of shufb for operands whose lanes have `Width` bytes. Written so that a constant pattern costs nothing: all but the
/// selection itself is folded.
template <int Width>
inline Bytes shuffle_bytes(Bytes a, Bytes b, Bytes pattern) {
  constexpr unsigned char kFlip = Width - 1;
  const Bytes control = permute_bytes<Width - 1>(pattern);  // of each host byte of the result
  const Bytes special = (Bytes)(control >= 0x80);
  const Bytes from_b = (Bytes)((control & 0x10) != 0);
  const Bytes index = (control & 0x0F) ^ kFlip;
#if !defined(__clang__)
  // GCC finds the one instruction for a constant selection only when it is told so in its own words.
  if (SC_SDK_KNOWN_ZERO(special)) return __builtin_shuffle(a, b, index | (from_b & 0x10));
#endif
  // A look-up gives 0 where its index has the top bit set.
  const Bytes take_a = index | ((special | from_b) & 0x80);
  const Bytes take_b = index | ((special | ~from_b) & 0x80);
  const Bytes all_ones = (Bytes)((control & 0xE0) == 0xC0), top_bit = (Bytes)((control & 0xE0) == 0xE0) & 0x80;
  return (Bytes)_mm_shuffle_epi8((__m128i)a, (__m128i)take_a) | (Bytes)_mm_shuffle_epi8((__m128i)b, (__m128i)take_b) | all_ones |
         top_bit;
}

}  // namespace softcell_sdk

/// Byte i is byte (pattern[i] & 31) of a followed by b; 10xxxxxx gives 0x00, 110xxxxx 0xFF, 111xxxxx 0x80. [SPU ISA, shufb] documented
template <class V, softcell_sdk::If<softcell_sdk::kVector<V>> = 0>
inline V spu_shuffle(const V& a, const V& b, const vec_uchar16& pattern) {
  using softcell_sdk::Bytes;
  return V::from_raw((softcell_sdk::Raw<typename V::Lane>)softcell_sdk::shuffle_bytes<V::kWidth>(
      (Bytes)a.raw, (Bytes)b.raw, (Bytes)pattern.raw));
}
inline qword spu_shuffle(const qword& a, const qword& b, const vec_uchar16& pattern) {
  return qword(spu_shuffle(vec_uint4(a), vec_uint4(b), pattern));
}

// ---- compares of integers; the result is a mask of unsigned lanes (floats: softcell_float.h)

template <class V, softcell_sdk::If<softcell_sdk::kInteger<V> && V::kWidth <= 4> = 0>
inline softcell_sdk::UnsignedOf<V> spu_cmpeq(const V& a, const V& b) {
  return softcell_sdk::UnsignedOf<V>::from_raw((softcell_sdk::Raw<typename softcell_sdk::UnsignedOf<V>::Lane>)(a.raw == b.raw));
}
template <class V, softcell_sdk::If<softcell_sdk::kInteger<V> && V::kWidth <= 4> = 0>
inline softcell_sdk::UnsignedOf<V> spu_cmpeq(const V& a, typename V::Lane b) {
  return spu_cmpeq(a, spu_splats(b));
}
template <class V, softcell_sdk::If<softcell_sdk::kInteger<V> && V::kWidth <= 4> = 0>
inline softcell_sdk::UnsignedOf<V> spu_cmpgt(const V& a, const V& b) {
  return softcell_sdk::UnsignedOf<V>::from_raw((softcell_sdk::Raw<typename softcell_sdk::UnsignedOf<V>::Lane>)(a.raw > b.raw));
}
template <class V, softcell_sdk::If<softcell_sdk::kInteger<V> && V::kWidth <= 4> = 0>
inline softcell_sdk::UnsignedOf<V> spu_cmpgt(const V& a, typename V::Lane b) {
  return spu_cmpgt(a, spu_splats(b));
}

// ---- gather and masks

/// The lowest bit of each lane, lane 0 first, in the low bits of word 0.
template <class V, softcell_sdk::If<softcell_sdk::kVector<V> && V::kWidth <= 4> = 0>
inline vec_uint4 spu_gather(const V& a) {
  const auto lanes = (softcell_sdk::Raw<typename softcell_sdk::UnsignedOf<V>::Lane>)a.raw;
  unsigned int bits = 0;
  if constexpr (V::kWidth == 4) {
    // The four low bits become the sign bits, which one instruction collects, lane 0 last.
    const unsigned int reversed = static_cast<unsigned int>(_mm_movemask_ps((__m128)_mm_slli_epi32((__m128i)lanes, 31)));
    bits = static_cast<unsigned int>(0xF7B3D591E6A2C480ull >> (4 * reversed)) & 0xFu;
  } else {
    for (int i = 0; i < V::kLanes; ++i) bits = bits << 1 | (lanes[i] & 1u);
  }
  return vec_uint4(bits, 0u, 0u, 0u);
}

namespace softcell_sdk {
template <class V>
inline V expand_mask(unsigned int bits) {
  V result;
  for (int i = 0; i < V::kLanes; ++i) {
    result.raw[i] = static_cast<typename V::Lane>((bits >> (V::kLanes - 1 - i) & 1u) != 0 ? ~0u : 0u);
  }
  return result;
}
}  // namespace softcell_sdk

/// Bit (15 - i), (7 - i), (3 - i) of the scalar, or of a vector's word 0, fills lane i.
#define SC_SDK_MASK(name, Name)                                                                       \
  inline Name name(unsigned int bits) { return softcell_sdk::expand_mask<Name>(bits); }               \
  inline Name name(int bits) { return name(static_cast<unsigned int>(bits)); }                        \
  inline Name name(unsigned short bits) { return name(static_cast<unsigned int>(bits)); }             \
  inline Name name(short bits) { return name(static_cast<unsigned int>(bits)); }                      \
  inline Name name(unsigned char bits) { return name(static_cast<unsigned int>(bits)); }              \
  inline Name name(signed char bits) { return name(static_cast<unsigned int>(bits)); }                \
  inline Name name(const vec_uint4& a) { return name(static_cast<unsigned int>(a.raw[0])); }
SC_SDK_MASK(spu_maskb, vec_uchar16)
SC_SDK_MASK(spu_maskh, vec_ushort8)
SC_SDK_MASK(spu_maskw, vec_uint4)
#undef SC_SDK_MASK
