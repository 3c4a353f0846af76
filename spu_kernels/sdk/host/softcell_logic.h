#pragma once
// Bit by bit: logic, selection, and the masks that compares make.  [LEXT, bits and mask intrinsics]
// documented

#include "softcell_lanes.h"

// ---- logic on the bits of any type, floats included

#define SC_SDK_LOGIC(name, expression)                                                                    \
  template <class T_>                                                                                     \
  SC_SDK_INLINE softcell_sdk::Vector<T_> name(softcell_sdk::Vector<T_> va, softcell_sdk::Vector<T_> vb) { \
    const auto a_ = softcell_sdk::wrap(va), b_ = softcell_sdk::wrap(vb);                                  \
    return softcell_sdk::make<softcell_sdk::Vector<T_>>(expression);                                      \
  }
SC_SDK_LOGIC(spu_and, a_& b_)
SC_SDK_LOGIC(spu_andc, a_ & ~b_)
SC_SDK_LOGIC(spu_eqv, ~(a_ ^ b_))
SC_SDK_LOGIC(spu_nand, ~(a_& b_))
SC_SDK_LOGIC(spu_nor, ~(a_ | b_))
SC_SDK_LOGIC(spu_or, a_ | b_)
SC_SDK_LOGIC(spu_orc, a_ | ~b_)
SC_SDK_LOGIC(spu_xor, a_ ^ b_)
#undef SC_SDK_LOGIC

// Three of them also take a scalar for every lane.
#define SC_SDK_LOGIC_SCALAR(name)                                                                         \
  template <class T_, softcell_sdk::If<softcell_sdk::kInteger<T_>> = 0>                                   \
  SC_SDK_INLINE softcell_sdk::Vector<T_> name(softcell_sdk::Vector<T_> a_, softcell_sdk::Scalar<T_> b_) { \
    return name(a_, softcell_sdk::splats<T_>(b_));                                                        \
  }
SC_SDK_LOGIC_SCALAR(spu_and)
SC_SDK_LOGIC_SCALAR(spu_or)
SC_SDK_LOGIC_SCALAR(spu_xor)
#undef SC_SDK_LOGIC_SCALAR

/// Bits of b where the mask has ones, of a where it has zeros.
template <class T_>
SC_SDK_INLINE softcell_sdk::Vector<T_> spu_sel(softcell_sdk::Vector<T_> a_, softcell_sdk::Vector<T_> b_,
                                               softcell_sdk::Vector<softcell_sdk::Unsigned<T_>> mask) {
  const auto m_ = mask.raw;
  return softcell_sdk::make<softcell_sdk::Vector<T_>>((softcell_sdk::wrap(b_) & m_) |
                                                      (softcell_sdk::wrap(a_) & ~m_));
}

/// The four words or-ed together in word 0; the others are 0.
template <class T_, softcell_sdk::If<softcell_sdk::kWord<T_>> = 0>
SC_SDK_INLINE softcell_sdk::Vector<T_> spu_orx(softcell_sdk::Vector<T_> a_) {
  const __m128i pairs = _mm_or_si128(softcell_sdk::bits(a_), _mm_srli_si128(softcell_sdk::bits(a_), 8));
  const __m128i all = _mm_or_si128(pairs, _mm_srli_si128(pairs, 4));
  return softcell_sdk::make<softcell_sdk::Vector<T_>>(_mm_and_si128(all, _mm_setr_epi32(-1, 0, 0, 0)));
}

// ---- from lanes to bits and back; the bit of lane 0 is the most significant one

/// The lowest bit of each lane, collected in the low 16, 8 or 4 bits of word 0.
template <class T_, softcell_sdk::If<softcell_sdk::kInteger<T_> || softcell_sdk::kSame<T_, float>> = 0>
SC_SDK_INLINE vec_uint4 spu_gather(softcell_sdk::Vector<T_> a_) {
  using namespace softcell_sdk;
  // The lowest bit of each lane to its top, lane 0 last, where one instruction collects it.
  unsigned int gathered;
  if constexpr (sizeof(T_) == 4) {
    const __m128i top = _mm_slli_epi32(bits(a_), 31);
    gathered = static_cast<unsigned int>(_mm_movemask_ps(_mm_castsi128_ps(_mm_shuffle_epi32(top, 0x1B))));
  } else if constexpr (sizeof(T_) == 2) {
    const __m128i top = _mm_slli_epi16(bits(a_), 15);
    const __m128i last_first = _mm_setr_epi8(15, 13, 11, 9, 7, 5, 3, 1, -1, -1, -1, -1, -1, -1, -1, -1);
    gathered = static_cast<unsigned int>(_mm_movemask_epi8(_mm_shuffle_epi8(top, last_first)));
  } else {
    const __m128i top = _mm_slli_epi16(bits(a_), 7);
    const __m128i last_first = _mm_setr_epi8(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    gathered = static_cast<unsigned int>(_mm_movemask_epi8(_mm_shuffle_epi8(top, last_first)));
  }
  return vec_uint4(gathered, 0);
}

namespace softcell_sdk {

/// Lane i all ones where bit (lanes - 1 - i) is set.
template <class T_>
SC_SDK_INLINE Vector<T_> expand_mask(unsigned int mask) {
  Raw<T_> bit;
  if constexpr (sizeof(T_) == 1) {
    // Each byte looks at its own half of the mask.
    const __m128i both = _mm_cvtsi32_si128(static_cast<int>(mask));
    bit = (Raw<T_>)_mm_setr_epi8(-128, 64, 32, 16, 8, 4, 2, 1, -128, 64, 32, 16, 8, 4, 2, 1);
    const auto spread =
        (Raw<T_>)_mm_shuffle_epi8(both, _mm_setr_epi8(1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0));
    return make<Vector<T_>>((spread & bit) == bit);
  } else {
    for (int i_ = 0; i_ < Vector<T_>::kLanes; ++i_)
      bit[i_] = static_cast<T_>(1u << (Vector<T_>::kLanes - 1 - i_));
    return make<Vector<T_>>((splats(static_cast<T_>(mask)).raw & bit) == bit);
  }
}

/// The scalars that the mask intrinsics take: exactly these, as on the SPU.
template <class S_>
inline constexpr bool kMaskScalar =
    kSame<S_, int> || kSame<S_, unsigned int> || kSame<S_, short> || kSame<S_, unsigned short> ||
    kSame<S_, signed char> || kSame<S_, unsigned char>;

}  // namespace softcell_sdk

/// Lane i all ones where bit (15 - i), (7 - i) or (3 - i) of the scalar is set.
template <class S_, softcell_sdk::If<softcell_sdk::kMaskScalar<S_> && sizeof(S_) >= 2> = 0>
SC_SDK_INLINE vec_uchar16 spu_maskb(S_ mask) {
  return softcell_sdk::expand_mask<unsigned char>(static_cast<unsigned int>(mask));
}
template <class S_, softcell_sdk::If<softcell_sdk::kMaskScalar<S_>> = 0>
SC_SDK_INLINE vec_ushort8 spu_maskh(S_ mask) {
  return softcell_sdk::expand_mask<unsigned short>(static_cast<unsigned int>(mask));
}
template <class S_, softcell_sdk::If<softcell_sdk::kMaskScalar<S_>> = 0>
SC_SDK_INLINE vec_uint4 spu_maskw(S_ mask) {
  return softcell_sdk::expand_mask<unsigned int>(static_cast<unsigned int>(mask));
}
