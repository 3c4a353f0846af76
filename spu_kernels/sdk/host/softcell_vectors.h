#pragma once
// The vector types of the Cell language extensions on a little-endian host.
//
// A vector is sixteen bytes, lane 0 first in memory, each lane in the host's byte order. The SPU numbers the bytes of a register from
// the most significant end: its byte i of a vector whose lanes have `width` bytes is the host's byte i ^ (width - 1). Casts and
// shuffles permute bytes by that rule, so that they mean what they mean on the SPU. [LEXT, data types] documented

#include <immintrin.h>
#include <stdint.h>

namespace softcell_sdk {

template <class Lane>
struct RawOf {
  typedef Lane Type __attribute__((vector_size(16)));
};
template <class Lane>
using Raw = typename RawOf<Lane>::Type;

typedef unsigned char Bytes __attribute__((vector_size(16)));
typedef unsigned long long Pair __attribute__((vector_size(16)));

/// The host's byte j comes from the host's byte j ^ Mask.
template <int Mask>
inline Bytes permute_bytes(Bytes b) {
  if constexpr (Mask == 0) {
    return b;
  } else {
    return __builtin_shufflevector(b, b, 0 ^ Mask, 1 ^ Mask, 2 ^ Mask, 3 ^ Mask, 4 ^ Mask, 5 ^ Mask, 6 ^ Mask, 7 ^ Mask,
                                   8 ^ Mask, 9 ^ Mask, 10 ^ Mask, 11 ^ Mask, 12 ^ Mask, 13 ^ Mask, 14 ^ Mask, 15 ^ Mask);
  }
}

/// What all vector types share. Self is the type itself, LaneType that of its lanes.
template <class Self, class LaneType>
struct Vector {
  using Lane = LaneType;
  static constexpr int kLanes = 16 / sizeof(LaneType);
  static constexpr int kWidth = sizeof(LaneType);
};

template <bool Condition>
struct EnableIf {};
template <>
struct EnableIf<true> {
  using Type = int;
};
/// Takes part in overload resolution only when the condition holds.
template <bool Condition>
using If = typename EnableIf<Condition>::Type;

template <class T>
inline constexpr int kIsVector = 0;

}  // namespace softcell_sdk

// One class for each type: no operators, only what the language extensions document. Raw vectors of the compiler go in and out by
// name (`raw`, from_raw), never silently.
#define SC_SDK_VECTOR(Name, LaneType)                                                                              \
  struct alignas(16) Name : softcell_sdk::Vector<Name, LaneType> {                                                 \
    softcell_sdk::Raw<LaneType> raw;                                                                               \
    Name() = default;                                                                                              \
    /* As many lanes as the type has. */                                                                           \
    template <class... L, softcell_sdk::If<sizeof...(L) == kLanes> = 0>                                            \
    constexpr Name(L... lanes) : raw{static_cast<LaneType>(lanes)...} {}                                           \
    /* A cast from another vector type keeps the SPU's bytes. */                                                   \
    template <class Other, class = decltype(Other::kLanes)>                                                        \
    explicit Name(const Other& other)                                                                              \
        : raw((softcell_sdk::Raw<LaneType>)softcell_sdk::permute_bytes<(Other::kWidth - 1) ^ (kWidth - 1)>(        \
              (softcell_sdk::Bytes)other.raw)) {}                                                                  \
    static Name from_raw(softcell_sdk::Raw<LaneType> value) {                                                      \
      Name result;                                                                                                 \
      result.raw = value;                                                                                          \
      return result;                                                                                               \
    }                                                                                                              \
  };                                                                                                               \
  template <>                                                                                                      \
  inline constexpr int softcell_sdk::kIsVector<Name> = 1;

SC_SDK_VECTOR(vec_uchar16, unsigned char)
SC_SDK_VECTOR(vec_char16, signed char)
SC_SDK_VECTOR(vec_ushort8, unsigned short)
SC_SDK_VECTOR(vec_short8, signed short)
SC_SDK_VECTOR(vec_uint4, unsigned int)
SC_SDK_VECTOR(vec_int4, signed int)
SC_SDK_VECTOR(vec_ullong2, unsigned long long)
SC_SDK_VECTOR(vec_llong2, signed long long)
SC_SDK_VECTOR(vec_float4, float)
SC_SDK_VECTOR(vec_double2, double)
#undef SC_SDK_VECTOR

/// A register without a type, for the specific intrinsics (si_*). It keeps its bytes as words do: word 0 is lane 0.
struct alignas(16) qword : softcell_sdk::Vector<qword, unsigned int> {
  softcell_sdk::Raw<unsigned int> raw;
  qword() = default;
  template <class Other, class = decltype(Other::kLanes)>
  explicit qword(const Other& other) : raw(vec_uint4(other).raw) {}
};

namespace softcell_sdk {

/// The unsigned and signed integer vectors with lanes of a given width.
template <int Width>
struct OfWidth;
template <>
struct OfWidth<1> {
  using Unsigned = vec_uchar16;
  using Signed = vec_char16;
};
template <>
struct OfWidth<2> {
  using Unsigned = vec_ushort8;
  using Signed = vec_short8;
};
template <>
struct OfWidth<4> {
  using Unsigned = vec_uint4;
  using Signed = vec_int4;
};
template <>
struct OfWidth<8> {
  using Unsigned = vec_ullong2;
  using Signed = vec_llong2;
};
template <class V>
using UnsignedOf = typename OfWidth<V::kWidth>::Unsigned;
template <class V>
using SignedOf = typename OfWidth<V::kWidth>::Signed;

template <class A, class B>
inline constexpr bool kSame = false;
template <class A>
inline constexpr bool kSame<A, A> = true;

template <class V>
inline constexpr bool kVector = kIsVector<V> == 1;
template <class V>
inline constexpr bool kFloating = kSame<V, vec_float4> || kSame<V, vec_double2>;
template <class V>
inline constexpr bool kInteger = kVector<V> && !kFloating<V>;
/// Halfwords and words: what most integer instructions work on.
template <class V>
inline constexpr bool kHalfOrWord = kSame<V, vec_ushort8> || kSame<V, vec_short8> || kSame<V, vec_uint4> || kSame<V, vec_int4>;

/// Lane by lane: result[i] = f(a[i], ...).
template <class R, class F, class... V>
inline R for_lanes(F f, const V&... operand) {
  R result{};
  for (int i = 0; i < R::kLanes; ++i) result.raw[i] = static_cast<typename R::Lane>(f(operand.raw[i]...));
  return result;
}

/// The same sixteen bytes under another type of the same lane width.
template <class To, class From>
inline To same_lanes(const From& from) {
  static_assert(To::kWidth == From::kWidth);
  return To::from_raw((Raw<typename To::Lane>)from.raw);
}

/// Integer arithmetic wraps: it is done on unsigned lanes.
template <class V>
inline Raw<typename UnsignedOf<V>::Lane> wrap(const V& v) {
  return (Raw<typename UnsignedOf<V>::Lane>)v.raw;
}
template <class V>
inline V unwrap(Raw<typename UnsignedOf<V>::Lane> raw) {
  return V::from_raw((Raw<typename V::Lane>)raw);
}

}  // namespace softcell_sdk
