#pragma once
// shufb: any sixteen of two registers' bytes.  [SPU-ISA, shufb] documented

#include "softcell_vectors.h"

namespace softcell_sdk {

/// Byte i of the result is byte (index[i] & 31) of a followed by b, in the host's numbering. A constant index
/// becomes the best one or two shuffles that the compiler knows.
SC_SDK_INLINE Bytes pick_bytes(Bytes a_, Bytes b_, Bytes index) {
#ifdef __clang__
  // pshufb gives 0 where bit 7 of its index is set; clang sees through it.
  const Bytes from_b = (Bytes)((index & 0x10) != 0) & 0x80, low = index & 0x0F;
  return (Bytes)_mm_shuffle_epi8((__m128i)a_, (__m128i)(low | from_b)) |
         (Bytes)_mm_shuffle_epi8((__m128i)b_, (__m128i)(low | (from_b ^ 0x80)));
#else
  return __builtin_shuffle(a_, b_, index);
#endif
}

/// shufb on operands whose lanes are Width bytes wide; the pattern's byte i speaks of the SPU's byte i.
template <int Width>
SC_SDK_INLINE Bytes shuffle_bytes(Bytes a_, Bytes b_, Bytes pattern) {
  constexpr unsigned char kFlip = Width - 1;
  const Bytes control = flip_bytes<kFlip>(pattern);
  const Bytes constant = (Bytes)(control >= 0x80);
  const Bytes ones = (Bytes)((control & 0xE0) == 0xC0), top_bit = (Bytes)((control & 0xE0) == 0xE0) & 0x80;
  return (pick_bytes(a_, b_, (control & 0x1F) ^ kFlip) & ~constant) | ones | top_bit;
}

}  // namespace softcell_sdk

/// Byte i is byte (pattern[i] & 31) of a followed by b, or 0x00 for a pattern of 10xxxxxx, 0xFF for 110xxxxx,
/// 0x80 for 111xxxxx.
template <class T_>
SC_SDK_INLINE softcell_sdk::Vector<T_> spu_shuffle(softcell_sdk::Vector<T_> a_, softcell_sdk::Vector<T_> b_,
                                                   vec_uchar16 pattern) {
  using softcell_sdk::Bytes;
  return softcell_sdk::make<softcell_sdk::Vector<T_>>(
      softcell_sdk::shuffle_bytes<sizeof(T_)>((Bytes)a_.raw, (Bytes)b_.raw, pattern.raw));
}
