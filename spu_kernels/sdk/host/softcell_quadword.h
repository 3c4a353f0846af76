#pragma once
// Shifts and rotates of the whole register as one number of 128 bits, byte 0 the most significant. [SPU ISA, quadword shifts] documented
//
// Names: ...qw by 0..7 bits, ...qwbyte by bytes, ...qwbytebc by bytes with the count in bits 3 and up. The rlmask forms shift right by the
// negated count, the sr forms by the count.

#include "softcell_logic.h"

namespace softcell_sdk {

/// The register as two halves of a number, most significant first.
struct Wide {
  uint64_t high, low;
};

template <class V>
inline Wide wide_of(const V& v) {
  const vec_ullong2 halves(v);
  return {halves.raw[0], halves.raw[1]};
}
template <class V>
inline V vector_of(const Wide& w) {
  return V(vec_ullong2(w.high, w.low));
}

inline Wide shift_left(Wide w, unsigned int bits) {
  if (bits >= 128) return {0, 0};
  if (bits >= 64) return {w.low << (bits - 64), 0};
  return bits == 0 ? w : Wide{w.high << bits | w.low >> (64 - bits), w.low << bits};
}
inline Wide shift_right(Wide w, unsigned int bits) {
  if (bits >= 128) return {0, 0};
  if (bits >= 64) return {0, w.high >> (bits - 64)};
  return bits == 0 ? w : Wide{w.high >> bits, w.low >> bits | w.high << (64 - bits)};
}
inline Wide rotate_left(Wide w, unsigned int bits) {
  const Wide left = shift_left(w, bits), right = shift_right(w, 128 - bits);
  return bits == 0 ? w : Wide{left.high | right.high, left.low | right.low};
}

}  // namespace softcell_sdk

// expression: the number of bits, from the scalar count n.
#define SC_SDK_QUADWORD(name, operation, expression)                                                     \
  template <class V, softcell_sdk::If<softcell_sdk::kVector<V>> = 0>                                     \
  inline V name(const V& a, int count) {                                                                 \
    const unsigned int n = static_cast<unsigned int>(count);                                             \
    return softcell_sdk::vector_of<V>(softcell_sdk::operation(softcell_sdk::wide_of(a), (expression)));   \
  }
SC_SDK_QUADWORD(spu_slqw, shift_left, n & 7u)
SC_SDK_QUADWORD(spu_slqwbyte, shift_left, 8u * (n & 31u))
SC_SDK_QUADWORD(spu_slqwbytebc, shift_left, 8u * (n >> 3 & 31u))
SC_SDK_QUADWORD(spu_rlqw, rotate_left, n & 7u)
SC_SDK_QUADWORD(spu_rlqwbyte, rotate_left, 8u * (n & 15u))
SC_SDK_QUADWORD(spu_rlqwbytebc, rotate_left, 8u * (n >> 3 & 15u))
SC_SDK_QUADWORD(spu_rlmaskqw, shift_right, (0u - n) & 7u)
SC_SDK_QUADWORD(spu_rlmaskqwbyte, shift_right, 8u * ((0u - n) & 31u))
SC_SDK_QUADWORD(spu_rlmaskqwbytebc, shift_right, 8u * ((0u - (n >> 3)) & 31u))
SC_SDK_QUADWORD(spu_srqw, shift_right, n & 7u)
SC_SDK_QUADWORD(spu_srqwbyte, shift_right, 8u * (n & 31u))
SC_SDK_QUADWORD(spu_srqwbytebc, shift_right, 8u * (n >> 3 & 31u))
#undef SC_SDK_QUADWORD
