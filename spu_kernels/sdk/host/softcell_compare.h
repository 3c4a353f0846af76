#pragma once
// Compares of integers lane by lane: all ones or zero, in unsigned lanes; and halts. Floats are compared in
// softcell_single.h, doubles in softcell_double.h.  [LEXT, compare intrinsics] documented

#include "softcell_environment.h"
#include "softcell_lanes.h"

#define SC_SDK_COMPARE(name, relation)                                                                   \
  template <class T_, softcell_sdk::If<softcell_sdk::kInteger<T_>> = 0>                                  \
  SC_SDK_INLINE softcell_sdk::Vector<softcell_sdk::Unsigned<T_>> name(softcell_sdk::Vector<T_> a_,       \
                                                                      softcell_sdk::Vector<T_> b_) {     \
    return softcell_sdk::make<softcell_sdk::Vector<softcell_sdk::Unsigned<T_>>>(a_.raw relation b_.raw); \
  }                                                                                                      \
  template <class T_, softcell_sdk::If<softcell_sdk::kInteger<T_>> = 0>                                  \
  SC_SDK_INLINE softcell_sdk::Vector<softcell_sdk::Unsigned<T_>> name(softcell_sdk::Vector<T_> a_,       \
                                                                      softcell_sdk::Scalar<T_> b_) {     \
    return name(a_, softcell_sdk::splats<T_>(b_));                                                       \
  }
SC_SDK_COMPARE(spu_cmpeq, ==)
SC_SDK_COMPARE(spu_cmpgt, >)
#undef SC_SDK_COMPARE

namespace softcell_sdk {
template <class A_>
inline constexpr bool kHaltScalar = kSame<A_, int> || kSame<A_, unsigned int>;
}

/// Halt the SPU when the condition holds: the emulator reports a fault and ends the program. The first
/// scalar's type decides between the signed and the unsigned compare.
template <class A_, softcell_sdk::If<softcell_sdk::kHaltScalar<A_>> = 0>
SC_SDK_INLINE void spu_hcmpeq(A_ a_, softcell_sdk::Scalar<A_> b_) {
  if (a_ == b_) softcell_sdk::call_gate(softcell_sdk::kHalt, 0, 0);
}
template <class A_, softcell_sdk::If<softcell_sdk::kHaltScalar<A_>> = 0>
SC_SDK_INLINE void spu_hcmpgt(A_ a_, softcell_sdk::Scalar<A_> b_) {
  if (a_ > b_) softcell_sdk::call_gate(softcell_sdk::kHalt, 0, 0);
}
