#pragma once
// Compares of integers lane by lane: all ones or zero, in unsigned lanes; and halts. Floats are compared in
// softcell_single.h, doubles in softcell_double.h.  [LEXT, compare intrinsics] documented

#include "softcell_environment.h"
#include "softcell_lanes.h"

#define SC_SDK_COMPARE(name, relation)                                                                \
  template <class T, softcell_sdk::If<softcell_sdk::kInteger<T>> = 0>                                 \
  SC_SDK_INLINE softcell_sdk::Vector<softcell_sdk::Unsigned<T>> name(softcell_sdk::Vector<T> a,       \
                                                                     softcell_sdk::Vector<T> b) {     \
    return softcell_sdk::make<softcell_sdk::Vector<softcell_sdk::Unsigned<T>>>(a.raw relation b.raw); \
  }                                                                                                   \
  template <class T, softcell_sdk::If<softcell_sdk::kInteger<T>> = 0>                                 \
  SC_SDK_INLINE softcell_sdk::Vector<softcell_sdk::Unsigned<T>> name(softcell_sdk::Vector<T> a,       \
                                                                     softcell_sdk::Scalar<T> b) {     \
    return name(a, softcell_sdk::splats<T>(b));                                                       \
  }
SC_SDK_COMPARE(spu_cmpeq, ==)
SC_SDK_COMPARE(spu_cmpgt, >)
#undef SC_SDK_COMPARE

namespace softcell_sdk {
template <class A>
inline constexpr bool kHaltScalar = kSame<A, int> || kSame<A, unsigned int>;
}

/// Halt the SPU when the condition holds: the emulator reports a fault and ends the program. The first
/// scalar's type decides between the signed and the unsigned compare.
template <class A, softcell_sdk::If<softcell_sdk::kHaltScalar<A>> = 0>
SC_SDK_INLINE void spu_hcmpeq(A a, softcell_sdk::Scalar<A> b) {
  if (a == b) softcell_sdk::call_gate(softcell_sdk::kHalt, 0, 0);
}
template <class A, softcell_sdk::If<softcell_sdk::kHaltScalar<A>> = 0>
SC_SDK_INLINE void spu_hcmpgt(A a, softcell_sdk::Scalar<A> b) {
  if (a > b) softcell_sdk::call_gate(softcell_sdk::kHalt, 0, 0);
}
