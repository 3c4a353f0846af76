#pragma once
// Scalars in and out of lanes.  [LEXT, vector and scalar intrinsics] documented

#include "softcell_vectors.h"

namespace softcell_sdk {

/// The lane type that a scalar of type T_ splats to. Only the exact scalar types have one: on the SPU, too,
/// spu_splats(true) is an error, and so is that of a `long`, which has 32 bits. Where it has 64, in tests that
/// include this from ordinary host code, it is a name of uint64_t.
template <class T_>
struct LaneOf {};
template <class T_>
struct LaneIs {
  using Type = T_;
};
template <>
struct LaneOf<unsigned char> : LaneIs<unsigned char> {};
template <>
struct LaneOf<signed char> : LaneIs<signed char> {};
template <>
struct LaneOf<unsigned short> : LaneIs<unsigned short> {};
template <>
struct LaneOf<signed short> : LaneIs<signed short> {};
template <>
struct LaneOf<unsigned int> : LaneIs<unsigned int> {};
template <>
struct LaneOf<signed int> : LaneIs<signed int> {};
#ifdef __LP64__
template <>
struct LaneOf<unsigned long> : LaneIs<unsigned long long> {};
template <>
struct LaneOf<signed long> : LaneIs<signed long long> {};
#endif
template <>
struct LaneOf<unsigned long long> : LaneIs<unsigned long long> {};
template <>
struct LaneOf<signed long long> : LaneIs<signed long long> {};
template <>
struct LaneOf<float> : LaneIs<float> {};
template <>
struct LaneOf<double> : LaneIs<double> {};

template <class T_>
SC_SDK_INLINE Vector<T_> splats(T_ value) {
  // A sum with zero, which is how the compiler's vectors broadcast, would not keep a float's bits under every
  // rounding mode.
  Vector<T_> result;
  if constexpr (sizeof(T_) == 1) {
    result.raw = Raw<T_>{value, value, value, value, value, value, value, value,
                         value, value, value, value, value, value, value, value};
  } else if constexpr (sizeof(T_) == 2) {
    result.raw = Raw<T_>{value, value, value, value, value, value, value, value};
  } else if constexpr (sizeof(T_) == 4) {
    result.raw = Raw<T_>{value, value, value, value};
  } else {
    result.raw = Raw<T_>{value, value};
  }
  return result;
}

}  // namespace softcell_sdk

/// The scalar in every lane.
template <class S_, class T_ = typename softcell_sdk::LaneOf<S_>::Type>
SC_SDK_INLINE softcell_sdk::Vector<T_> spu_splats(S_ value) {
  return softcell_sdk::splats(static_cast<T_>(value));
}

/// The scalar in lane `element` modulo the number of lanes. The SPU leaves the others undefined; here they
/// hold it too.
template <class S_, class T_ = typename softcell_sdk::LaneOf<S_>::Type>
SC_SDK_INLINE softcell_sdk::Vector<T_> spu_promote(S_ value, int) {
  return softcell_sdk::splats(static_cast<T_>(value));
}

/// Lane `element` modulo the number of lanes.
template <class T_>
SC_SDK_INLINE T_ spu_extract(softcell_sdk::Vector<T_> a_, int element) {
  return a_.raw[element & (a_.kLanes - 1)];
}

/// `a` with the scalar in lane `element` modulo the number of lanes.
template <class T_>
SC_SDK_INLINE softcell_sdk::Vector<T_> spu_insert(softcell_sdk::Scalar<T_> value, softcell_sdk::Vector<T_> a_,
                                                  int element) {
  a_.raw[element & (a_.kLanes - 1)] = value;
  return a_;
}
