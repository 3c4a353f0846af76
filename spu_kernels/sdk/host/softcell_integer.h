#pragma once
// Integer arithmetic, shifts and rotates. [LEXT, generic intrinsics; SPU ISA] documented

#include "softcell_logic.h"

// ---- add and subtract; a scalar may be the second operand of an addition and the first of a subtraction

template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_add(const V& a, const V& b) {
  return softcell_sdk::unwrap<V>(softcell_sdk::wrap(a) + softcell_sdk::wrap(b));
}
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_add(const V& a, typename V::Lane b) {
  return spu_add(a, spu_splats(b));
}
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_sub(const V& a, const V& b) {
  return softcell_sdk::unwrap<V>(softcell_sdk::wrap(a) - softcell_sdk::wrap(b));
}
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_sub(typename V::Lane a, const V& b) {
  return spu_sub(spu_splats(a), b);
}

#define SC_SDK_WORD_TYPES(X) X(vec_uint4) X(vec_int4)

// Carry and borrow, one word each. A borrow of 1 means none was needed.
#define SC_SDK_CARRY(V)                                                                                                       \
  inline V spu_addx(const V& a, const V& b, const V& c) {                                                                     \
    return softcell_sdk::unwrap<V>(softcell_sdk::wrap(a) + softcell_sdk::wrap(b) + (softcell_sdk::wrap(c) & 1u));             \
  }                                                                                                                           \
  inline V spu_subx(const V& a, const V& b, const V& c) {                                                                     \
    return softcell_sdk::unwrap<V>(softcell_sdk::wrap(a) + ~softcell_sdk::wrap(b) + (softcell_sdk::wrap(c) & 1u));            \
  }                                                                                                                           \
  inline V spu_genc(const V& a, const V& b) {                                                                                 \
    return softcell_sdk::for_lanes<V>(                                                                                        \
        [](auto x, auto y) { return (uint64_t{static_cast<uint32_t>(x)} + static_cast<uint32_t>(y)) >> 32; }, a, b);          \
  }                                                                                                                           \
  inline V spu_gencx(const V& a, const V& b, const V& c) {                                                                    \
    return softcell_sdk::for_lanes<V>(                                                                                        \
        [](auto x, auto y, auto z) {                                                                                          \
          return (uint64_t{static_cast<uint32_t>(x)} + static_cast<uint32_t>(y) + (static_cast<uint32_t>(z) & 1u)) >> 32;     \
        },                                                                                                                    \
        a, b, c);                                                                                                             \
  }                                                                                                                           \
  inline V spu_genb(const V& a, const V& b) {                                                                                 \
    return softcell_sdk::for_lanes<V>([](auto x, auto y) { return static_cast<uint32_t>(x) >= static_cast<uint32_t>(y); }, a, b); \
  }                                                                                                                           \
  inline V spu_genbx(const V& a, const V& b, const V& c) {                                                                    \
    return softcell_sdk::for_lanes<V>(                                                                                        \
        [](auto x, auto y, auto z) {                                                                                          \
          const uint32_t p = static_cast<uint32_t>(x), q = static_cast<uint32_t>(y);                                          \
          return (static_cast<uint32_t>(z) & 1u) != 0 ? p >= q : p > q;                                                       \
        },                                                                                                                    \
        a, b, c);                                                                                                             \
  }
SC_SDK_WORD_TYPES(SC_SDK_CARRY)
#undef SC_SDK_CARRY

// ---- multiply: halfwords of 16 bits to words of 32; "even" is the high half of a word, lane 0 first

inline vec_int4 spu_mulo(const vec_short8& a, const vec_short8& b) {
  vec_int4 r{};
  for (int i = 0; i < 4; ++i) r.raw[i] = a.raw[2 * i + 1] * b.raw[2 * i + 1];
  return r;
}
inline vec_uint4 spu_mulo(const vec_ushort8& a, const vec_ushort8& b) {
  vec_uint4 r{};
  for (int i = 0; i < 4; ++i) r.raw[i] = uint32_t{a.raw[2 * i + 1]} * b.raw[2 * i + 1];
  return r;
}
inline vec_int4 spu_mulo(const vec_short8& a, short b) { return spu_mulo(a, spu_splats(b)); }
inline vec_uint4 spu_mulo(const vec_ushort8& a, unsigned short b) { return spu_mulo(a, spu_splats(b)); }
inline vec_int4 spu_mule(const vec_short8& a, const vec_short8& b) {
  vec_int4 r{};
  for (int i = 0; i < 4; ++i) r.raw[i] = a.raw[2 * i] * b.raw[2 * i];
  return r;
}
inline vec_uint4 spu_mule(const vec_ushort8& a, const vec_ushort8& b) {
  vec_uint4 r{};
  for (int i = 0; i < 4; ++i) r.raw[i] = uint32_t{a.raw[2 * i]} * b.raw[2 * i];
  return r;
}
/// High half of a times low half of b, shifted to the high half: the cross term of a 32-bit product.
inline vec_int4 spu_mulh(const vec_short8& a, const vec_short8& b) {
  vec_int4 r{};
  for (int i = 0; i < 4; ++i) {
    r.raw[i] = static_cast<int>((static_cast<uint32_t>(a.raw[2 * i]) * static_cast<uint32_t>(b.raw[2 * i + 1])) << 16);
  }
  return r;
}
/// The upper half of the product of the low halves, sign-extended.
inline vec_int4 spu_mulsr(const vec_short8& a, const vec_short8& b) {
  vec_int4 r{};
  for (int i = 0; i < 4; ++i) r.raw[i] = (a.raw[2 * i + 1] * b.raw[2 * i + 1]) >> 16;
  return r;
}
/// Low halves multiplied and added to c.
inline vec_int4 spu_madd(const vec_short8& a, const vec_short8& b, const vec_int4& c) { return spu_add(spu_mulo(a, b), c); }
/// High halves multiplied and added to c.
inline vec_int4 spu_mhhadd(const vec_short8& a, const vec_short8& b, const vec_int4& c) { return spu_add(spu_mule(a, b), c); }
inline vec_uint4 spu_mhhadd(const vec_ushort8& a, const vec_ushort8& b, const vec_uint4& c) { return spu_add(spu_mule(a, b), c); }

// ---- bytes, bits, widening

inline vec_uchar16 spu_absd(const vec_uchar16& a, const vec_uchar16& b) {
  return softcell_sdk::for_lanes<vec_uchar16>([](int x, int y) { return x > y ? x - y : y - x; }, a, b);
}
inline vec_uchar16 spu_avg(const vec_uchar16& a, const vec_uchar16& b) {
  return softcell_sdk::for_lanes<vec_uchar16>([](int x, int y) { return (x + y + 1) >> 1; }, a, b);
}
/// Each word: the four bytes of b summed in its high half, those of a in its low half.
inline vec_ushort8 spu_sumb(const vec_uchar16& a, const vec_uchar16& b) {
  vec_ushort8 r{};
  for (int i = 0; i < 16; ++i) {
    r.raw[i / 4 * 2] = static_cast<unsigned short>(r.raw[i / 4 * 2] + b.raw[i]);
    r.raw[i / 4 * 2 + 1] = static_cast<unsigned short>(r.raw[i / 4 * 2 + 1] + a.raw[i]);
  }
  return r;
}
/// Ones in each byte.
template <class V, softcell_sdk::If<softcell_sdk::kVector<V> && V::kWidth == 1> = 0>
inline vec_uchar16 spu_cntb(const V& a) {
  return softcell_sdk::for_lanes<vec_uchar16>([](auto x) { return __builtin_popcount(static_cast<unsigned char>(x)); }, a);
}
/// Leading zeros of each word, 32 for 0.
template <class V, softcell_sdk::If<softcell_sdk::kVector<V> && V::kWidth == 4> = 0>
inline vec_uint4 spu_cntlz(const V& a) {
  return softcell_sdk::for_lanes<vec_uint4>([](uint32_t x) { return x == 0 ? 32 : __builtin_clz(x); },
                                            softcell_sdk::same_lanes<vec_uint4>(a));
}
/// The low half of each lane of the result's width, sign-extended: odd lanes of `a`.
inline vec_short8 spu_extend(const vec_char16& a) {
  vec_short8 r{};
  for (int i = 0; i < 8; ++i) r.raw[i] = a.raw[2 * i + 1];
  return r;
}
inline vec_int4 spu_extend(const vec_short8& a) {
  vec_int4 r{};
  for (int i = 0; i < 4; ++i) r.raw[i] = a.raw[2 * i + 1];
  return r;
}
inline vec_llong2 spu_extend(const vec_int4& a) {
  vec_llong2 r{};
  for (int i = 0; i < 2; ++i) r.raw[i] = a.raw[2 * i + 1];
  return r;
}

// ---- shifts and rotates of each lane, by a count of each lane or one scalar

namespace softcell_sdk {

/// Counts as the instructions read them: one bit more than the lane's own, so that "everything" can be said.
template <class V>
inline constexpr unsigned int kCountMask = 2 * 8 * V::kWidth - 1;

template <class V>
inline uint32_t shifted_left(typename UnsignedOf<V>::Lane x, unsigned int n) {
  return n >= 8u * V::kWidth ? 0 : static_cast<uint32_t>(x) << n;
}
template <class V>
inline uint32_t shifted_right(typename UnsignedOf<V>::Lane x, unsigned int n) {
  return n >= 8u * V::kWidth ? 0 : static_cast<uint32_t>(x) >> n;
}
template <class V>
inline int32_t shifted_right_signed(typename SignedOf<V>::Lane x, unsigned int n) {
  constexpr unsigned int kMost = 8 * V::kWidth - 1;
  return static_cast<int32_t>(x) >> (n > kMost ? kMost : n);
}

}  // namespace softcell_sdk

/// a << count; counts are taken modulo twice the lane's bits, and 0 comes out from the lane's bits on.
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_sl(const V& a, const softcell_sdk::UnsignedOf<V>& count) {
  using namespace softcell_sdk;
  if constexpr (V::kWidth == 4) {
    return V::from_raw((Raw<typename V::Lane>)_mm_sllv_epi32((__m128i)a.raw, (__m128i)(count.raw & 63u)));
  } else {
    return for_lanes<V>([](auto x, unsigned int n) { return shifted_left<V>(static_cast<unsigned short>(x), n & kCountMask<V>); }, a, count);
  }
}
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_sl(const V& a, unsigned int count) {
  return spu_sl(a, spu_splats(static_cast<typename softcell_sdk::UnsignedOf<V>::Lane>(count)));
}

/// Logical shift right by the negated count. [SPU ISA, rotm, rothm] documented
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_rlmask(const V& a, const softcell_sdk::SignedOf<V>& count) {
  using namespace softcell_sdk;
  if constexpr (V::kWidth == 4) {
    return V::from_raw((Raw<typename V::Lane>)_mm_srlv_epi32((__m128i)a.raw, (__m128i)(-wrap(count) & 63u)));
  } else {
    return for_lanes<V>(
        [](auto x, int n) { return shifted_right<V>(static_cast<unsigned short>(x), static_cast<unsigned int>(-n) & kCountMask<V>); }, a, count);
  }
}
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_rlmask(const V& a, int count) {
  return spu_rlmask(a, spu_splats(static_cast<typename softcell_sdk::SignedOf<V>::Lane>(count)));
}

/// Arithmetic shift right by the negated count. [SPU ISA, rotma, rotmah] documented
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_rlmaska(const V& a, const softcell_sdk::SignedOf<V>& count) {
  using namespace softcell_sdk;
  if constexpr (V::kWidth == 4) {
    return V::from_raw((Raw<typename V::Lane>)_mm_srav_epi32((__m128i)a.raw, (__m128i)(-wrap(count) & 63u)));
  } else {
    return for_lanes<V>(
        [](auto x, int n) { return shifted_right_signed<V>(static_cast<short>(x), static_cast<unsigned int>(-n) & kCountMask<V>); }, a, count);
  }
}
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_rlmaska(const V& a, int count) {
  return spu_rlmaska(a, spu_splats(static_cast<typename softcell_sdk::SignedOf<V>::Lane>(count)));
}

/// Shifts right by the count itself: the same instructions, the count negated for them.
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_sr(const V& a, const softcell_sdk::UnsignedOf<V>& count) {
  return spu_rlmask(a, softcell_sdk::SignedOf<V>::from_raw((softcell_sdk::Raw<typename softcell_sdk::SignedOf<V>::Lane>)(-count.raw)));
}
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_sr(const V& a, unsigned int count) {
  return spu_rlmask(a, static_cast<int>(0u - count));
}
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_sra(const V& a, const softcell_sdk::UnsignedOf<V>& count) {
  return spu_rlmaska(a, softcell_sdk::SignedOf<V>::from_raw((softcell_sdk::Raw<typename softcell_sdk::SignedOf<V>::Lane>)(-count.raw)));
}
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_sra(const V& a, unsigned int count) {
  return spu_rlmaska(a, static_cast<int>(0u - count));
}

/// Rotate left; counts modulo the lane's bits.
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_rl(const V& a, const softcell_sdk::SignedOf<V>& count) {
  constexpr unsigned int kBits = 8 * V::kWidth;
  return softcell_sdk::for_lanes<V>(
      [](auto lane, int n) {
        const auto x = static_cast<uint32_t>(static_cast<typename softcell_sdk::UnsignedOf<V>::Lane>(lane));
        const unsigned int left = static_cast<unsigned int>(n) & (kBits - 1);
        return x << left | (left == 0 ? 0 : x >> (kBits - left));
      },
      a, count);
}
template <class V, softcell_sdk::If<softcell_sdk::kHalfOrWord<V>> = 0>
inline V spu_rl(const V& a, int count) {
  return spu_rl(a, spu_splats(static_cast<typename softcell_sdk::SignedOf<V>::Lane>(count)));
}
