#pragma once
// The vector types of the Cell language extensions on a little-endian host.  [LEXT, data types] documented
//
// A vector is sixteen bytes, lane 0 first in memory, each lane in the host's byte order. The SPU numbers the
// bytes of a register from its most significant end: its byte i of a vector whose lanes are `width` bytes
// wide is the host's byte i ^ (width - 1):
//
//   vec_uint4 {0x00112233, 0x44556677, ..}     SPU bytes    00 11 22 33 44 55 66 77 ..
//                                              host bytes   33 22 11 00 77 66 55 44 ..
//
// A cast between lane widths permutes bytes by that rule, and so means what it means on the SPU; between
// equal widths it keeps the lanes. What cannot be kept is punning through memory: an array of words read as
// bytes shows the host's order.

#include <stdint.h>
#include "softcell_host_vectors.h"

#define SC_SDK_INLINE __attribute__((always_inline)) inline
// Like the SPU's vectors, ours may look at memory that was written as something else.
#define SC_SDK_REGISTER __attribute__((may_alias, aligned(16)))

#define SC_SDK_IS_NO_CONDITION                                                       \
  __attribute__((                                                                    \
      error("a vector is no condition: write spu_sel(b, a, mask) for mask ? a : b, " \
            "and ask for a lane with spu_extract()")))

namespace softcell_sdk {

template <class Lane>
struct RawOf {
  typedef Lane Type __attribute__((vector_size(16)));
};
/// The compiler's own vector of these lanes.
template <class Lane>
using Raw = typename RawOf<Lane>::Type;
using Bytes = Raw<unsigned char>;

/// Reads byte j of the result from byte j ^ Flip: from one lane width to another, or from the host's numbers
/// to the SPU's.
template <int Flip>
SC_SDK_INLINE Bytes flip_bytes(Bytes b_) {
  if constexpr (Flip == 0) {
    return b_;
  } else {
    return __builtin_shufflevector(b_, b_, 0 ^ Flip, 1 ^ Flip, 2 ^ Flip, 3 ^ Flip, 4 ^ Flip, 5 ^ Flip,
                                   6 ^ Flip, 7 ^ Flip, 8 ^ Flip, 9 ^ Flip, 10 ^ Flip, 11 ^ Flip, 12 ^ Flip,
                                   13 ^ Flip, 14 ^ Flip, 15 ^ Flip);
  }
}

/// The storage of N_ lanes and how to name them. `mutable` is for g++: it takes a const variable of a class
/// for read-only memory, unless it has a mutable member, and then keeps it in memory and not in a register.
/// As on the SPU the lanes left out are zero.
template <class T_, int N_>
struct Lanes;

/// The one lane of `{x}`; a scalar alone is not converted to a vector.
template <class T_>
struct First {
  constexpr First(T_ lane) : value(lane) {}
  T_ value;
};

template <class A_, class B_>
struct IfSame {};
template <class A_>
struct IfSame<A_, A_> {
  using Type = int;
};

template <class T_>
struct SC_SDK_REGISTER Lanes<T_, 2> {
  mutable Raw<T_> raw;
  Lanes() = default;
  constexpr Lanes(First<T_> l0) : raw{l0.value} {}
  constexpr Lanes(T_ l0, T_ l1) : raw{l0, l1} {}
};
template <class T_>
struct SC_SDK_REGISTER Lanes<T_, 4> {
  mutable Raw<T_> raw;
  Lanes() = default;
  constexpr Lanes(First<T_> l0) : raw{l0.value} {}
  constexpr Lanes(T_ l0, T_ l1, T_ l2 = T_(), T_ l3 = T_()) : raw{l0, l1, l2, l3} {}
};
template <class T_>
struct SC_SDK_REGISTER Lanes<T_, 8> {
  mutable Raw<T_> raw;
  Lanes() = default;
  constexpr Lanes(First<T_> l0) : raw{l0.value} {}
  constexpr Lanes(T_ l0, T_ l1, T_ l2 = T_(), T_ l3 = T_(), T_ l4 = T_(), T_ l5 = T_(), T_ l6 = T_(),
                  T_ l7 = T_())
      : raw{l0, l1, l2, l3, l4, l5, l6, l7} {}
};
template <class T_>
struct SC_SDK_REGISTER Lanes<T_, 16> {
  mutable Raw<T_> raw;
  Lanes() = default;
  constexpr Lanes(First<T_> l0) : raw{l0.value} {}
  constexpr Lanes(T_ l0, T_ l1, T_ l2 = T_(), T_ l3 = T_(), T_ l4 = T_(), T_ l5 = T_(), T_ l6 = T_(),
                  T_ l7 = T_(), T_ l8 = T_(), T_ l9 = T_(), T_ l10 = T_(), T_ l11 = T_(), T_ l12 = T_(),
                  T_ l13 = T_(), T_ l14 = T_(), T_ l15 = T_())
      : raw{l0, l1, l2, l3, l4, l5, l6, l7, l8, l9, l10, l11, l12, l13, l14, l15} {}
};

/// One vector type for each lane type. Its operators are in softcell_operators.h.
template <class T_>
struct SC_SDK_REGISTER Vector : Lanes<T_, 16 / sizeof(T_)> {
  using Lane = T_;
  static constexpr int kWidth = sizeof(T_);
  static constexpr int kLanes = 16 / kWidth;

  Vector() = default;
  using Lanes<T_, 16 / sizeof(T_)>::Lanes;

  /// A cast from another vector type, qword included.
  template <class Other, int = Other::kWidth>
  SC_SDK_INLINE explicit Vector(const Other& other) {
    this->raw = (Raw<T_>)flip_bytes<(Other::kWidth - 1) ^ (kWidth - 1)>((Bytes)other.raw);
  }

  // To and from volatile vectors. As templates they are no copies of the language's own, which stay trivial.
  template <class U_, typename IfSame<U_, T_>::Type = 0>
  SC_SDK_INLINE Vector(const volatile Vector<U_>& other) {
    this->raw = other.raw;
  }
  template <class U_, typename IfSame<U_, T_>::Type = 0>
  SC_SDK_INLINE void operator=(Vector<U_> other) volatile {
    this->raw = other.raw;
  }

  SC_SDK_IS_NO_CONDITION explicit operator bool() const;

  /// A lane.
  SC_SDK_INLINE T_& operator[](int lane) { return reinterpret_cast<T_*>(&this->raw)[lane]; }
  SC_SDK_INLINE const T_& operator[](int lane) const { return reinterpret_cast<const T_*>(&this->raw)[lane]; }
  SC_SDK_INLINE volatile T_& operator[](int lane) volatile {
    return reinterpret_cast<volatile T_*>(&this->raw)[lane];
  }
};

#undef SC_SDK_IS_NO_CONDITION

}  // namespace softcell_sdk

using vec_uchar16 = softcell_sdk::Vector<unsigned char>;
using vec_char16 = softcell_sdk::Vector<signed char>;
using vec_ushort8 = softcell_sdk::Vector<unsigned short>;
using vec_short8 = softcell_sdk::Vector<signed short>;
using vec_uint4 = softcell_sdk::Vector<unsigned int>;
using vec_int4 = softcell_sdk::Vector<signed int>;
using vec_ullong2 = softcell_sdk::Vector<unsigned long long>;
using vec_llong2 = softcell_sdk::Vector<signed long long>;
using vec_float4 = softcell_sdk::Vector<float>;
using vec_double2 = softcell_sdk::Vector<double>;

/// A register without a type, for the specific intrinsics (si_*). In memory it is a vector of words; casts do
/// the rest. For an SPU's compiler it is a vec_char16, and needs no casts to and from one.
struct SC_SDK_REGISTER qword {
  static constexpr int kWidth = 4;
  mutable softcell_sdk::Raw<unsigned int> raw;

  qword() = default;
  template <class T_>
  SC_SDK_INLINE explicit qword(const softcell_sdk::Vector<T_>& v_) : raw(vec_uint4(v_).raw) {}
  SC_SDK_INLINE qword(const vec_char16& v_) : raw(vec_uint4(v_).raw) {}
  SC_SDK_INLINE operator vec_char16() const { return vec_char16(*this); }
};

namespace softcell_sdk {

template <bool Condition>
struct EnableIf {};
template <>
struct EnableIf<true> {
  using Type = int;
};
/// Takes part in overload resolution only when the condition holds.
template <bool Condition>
using If = typename EnableIf<Condition>::Type;

template <class T_>
struct Same {
  using Type = T_;
};
/// T_, but given by the other arguments: this one is converted to it.
template <class T_>
using Scalar = typename Same<T_>::Type;

template <class A_, class B_>
inline constexpr bool kSame = false;
template <class A_>
inline constexpr bool kSame<A_, A_> = true;

template <class T_>
inline constexpr bool kFloating = kSame<T_, float> || kSame<T_, double>;
/// Bytes, halfwords and words.
template <class T_>
inline constexpr bool kInteger = !kFloating<T_> && sizeof(T_) <= 4;
/// Halfwords and words: what most integer instructions work on.
template <class T_>
inline constexpr bool kHalfOrWord = kInteger<T_> && sizeof(T_) >= 2;
template <class T_>
inline constexpr bool kWord = kInteger<T_> && sizeof(T_) == 4;

template <int Width>
struct OfWidth;
template <>
struct OfWidth<1> {
  using Unsigned = unsigned char;
  using Signed = signed char;
};
template <>
struct OfWidth<2> {
  using Unsigned = unsigned short;
  using Signed = signed short;
};
template <>
struct OfWidth<4> {
  using Unsigned = unsigned int;
  using Signed = signed int;
};
template <>
struct OfWidth<8> {
  using Unsigned = unsigned long long;
  using Signed = signed long long;
};
/// The integer lane as wide as T_: of masks, and of shift counts.
template <class T_>
using Unsigned = typename OfWidth<sizeof(T_)>::Unsigned;
template <class T_>
using Signed = typename OfWidth<sizeof(T_)>::Signed;

/// The sixteen bytes as the host's instructions take them, and back.
template <class V_>
SC_SDK_INLINE __m128i bits(const V_& v_) {
  return (__m128i)v_.raw;
}
template <class V_, class AnyRaw>
SC_SDK_INLINE V_ make(AnyRaw raw) {
  static_assert(sizeof(raw) == 16);
  V_ result;
  result.raw = (decltype(V_::raw))raw;
  return result;
}

/// Clang computes even (float)0 at run time when told not to rely on a rounding mode; zero bits it knows.
SC_SDK_INLINE __m128 zero_floats() { return (__m128)_mm_setzero_si128(); }

/// Integer arithmetic wraps: it is done on unsigned lanes.
template <class T_>
SC_SDK_INLINE Raw<Unsigned<T_>> wrap(const Vector<T_>& v_) {
  return (Raw<Unsigned<T_>>)v_.raw;
}

}  // namespace softcell_sdk
