#pragma once
// The vector operations of VMX by those of an SPU, in C++: what programs that were written for the PPU side commonly use.
// [SDK for Multicore Acceleration; AltiVec Technology Programming Interface Manual] documented
//
// Differences of the SPU stay: floats truncate and are always numbers, and vec_re() and vec_rsqrte() estimate to 12 bits. The operations on
// single bits of whole registers (vec_sll, vec_srl), sums across lanes and pixels are missing.

#include <vec_types.h>

#ifdef __cplusplus

namespace softcell_vmx {

template <class Vector>
const Vector& any();
template <class Vector>
struct Lanes {
  using Number = decltype(spu_extract(any<Vector>(), 0));
  static constexpr int kCount = sizeof(Vector) / sizeof(Number);
  static constexpr bool kIsUnsigned = Number(-1) > Number(0);
  static constexpr bool kIsWhole = Number(1) / Number(2) == Number(0);
};
template <class Vector>
using Lane = typename Lanes<Vector>::Number;

/// The type of a vector of Scalar, or Scalar itself where it is one.
template <class Scalar>
struct VectorOf {
  using Type = Scalar;
};
#define SC_VMX_VECTOR_OF(Scalar, vector_type) \
  template <>                                 \
  struct VectorOf<Scalar> {                   \
    using Type = vector_type;                 \
  };
SC_VMX_VECTOR_OF(unsigned char, vec_uchar16)
SC_VMX_VECTOR_OF(signed char, vec_char16)
SC_VMX_VECTOR_OF(char, vec_uchar16)
SC_VMX_VECTOR_OF(unsigned short, vec_ushort8)
SC_VMX_VECTOR_OF(short, vec_short8)
SC_VMX_VECTOR_OF(unsigned int, vec_uint4)
SC_VMX_VECTOR_OF(unsigned long, vec_uint4)
SC_VMX_VECTOR_OF(int, vec_int4)
SC_VMX_VECTOR_OF(long, vec_int4)
SC_VMX_VECTOR_OF(float, vec_float4)
#undef SC_VMX_VECTOR_OF

/// Unsigned numbers of the size of one lane: what comparisons give, and shifts take.
template <int kBytes>
struct MaskOf;
template <>
struct MaskOf<1> {
  using Type = vec_uchar16;
};
template <>
struct MaskOf<2> {
  using Type = vec_ushort8;
};
template <>
struct MaskOf<4> {
  using Type = vec_uint4;
};
template <class Vector>
using Mask = typename MaskOf<sizeof(Lane<Vector>)>::Type;

/// Of a mask and something else, the type of the other; otherwise that of the first.
template <class First, class Second,
          bool kSame = sizeof(Lane<First>) == sizeof(Lane<Second>) && Lanes<First>::kIsUnsigned>
struct Joined {
  using Type = First;
};
template <class First, class Second>
struct Joined<First, Second, true> {
  using Type = Second;
};

template <class Result, class Function>
inline Result of_lanes(const Function& function) {
  Result result = (Result)spu_splats((unsigned char)0);
  for (int lane = 0; lane < Lanes<Result>::kCount; ++lane)
    result = spu_insert((Lane<Result>)function(lane), result, lane);
  return result;
}

/// Cut to what a number of the type can be.
template <class Number>
inline Number saturated(long long value) {
  constexpr bool kIsUnsigned = Number(-1) > Number(0);
  constexpr int kBits = 8 * sizeof(Number);
  constexpr long long kMost = kIsUnsigned ? (1ll << kBits) - 1 : (1ll << (kBits - 1)) - 1;
  constexpr long long kLeast = kIsUnsigned ? 0 : -kMost - 1;
  return (Number)(value > kMost ? kMost : value < kLeast ? kLeast : value);
}

template <class Result, class Vector>
inline Result packed(Vector one, Vector two) {
  constexpr int kHalf = Lanes<Vector>::kCount;
  return of_lanes<Result>(
      [&](int lane) { return lane < kHalf ? spu_extract(one, lane) : spu_extract(two, lane - kHalf); });
}
template <class Result, class Vector>
inline Result packed_saturated(Vector one, Vector two) {
  constexpr int kHalf = Lanes<Vector>::kCount;
  return of_lanes<Result>([&](int lane) {
    return saturated<Lane<Result>>(lane < kHalf ? spu_extract(one, lane) : spu_extract(two, lane - kHalf));
  });
}

template <class Vector>
inline bool are_all(Vector mask) {
  return spu_extract(spu_gather(spu_cmpeq((vec_uint4)mask, 0xFFFFFFFFu)), 0) == 15;
}
template <class Vector>
inline bool is_any(Vector mask) {
  return spu_extract(spu_gather(spu_cmpeq((vec_uint4)mask, 0u)), 0) != 15;
}

inline unsigned char* quadword_at(int offset, const volatile void* base) {
  return (unsigned char*)(((__UINTPTR_TYPE__)base + offset) & ~(__UINTPTR_TYPE__)15);
}

}  // namespace softcell_vmx

// ---- numbers

template <class Vector>
inline Vector vec_add(Vector one, Vector two) {
  return softcell_vmx::of_lanes<Vector>(
      [&](int lane) { return spu_extract(one, lane) + spu_extract(two, lane); });
}
inline vec_float4 vec_add(vec_float4 one, vec_float4 two) { return spu_add(one, two); }
inline vec_uint4 vec_add(vec_uint4 one, vec_uint4 two) { return spu_add(one, two); }
inline vec_int4 vec_add(vec_int4 one, vec_int4 two) { return spu_add(one, two); }
inline vec_ushort8 vec_add(vec_ushort8 one, vec_ushort8 two) { return spu_add(one, two); }
inline vec_short8 vec_add(vec_short8 one, vec_short8 two) { return spu_add(one, two); }
template <class Vector>
inline Vector vec_sub(Vector one, Vector two) {
  return softcell_vmx::of_lanes<Vector>(
      [&](int lane) { return spu_extract(one, lane) - spu_extract(two, lane); });
}
inline vec_float4 vec_sub(vec_float4 one, vec_float4 two) { return spu_sub(one, two); }
inline vec_uint4 vec_sub(vec_uint4 one, vec_uint4 two) { return spu_sub(one, two); }
inline vec_int4 vec_sub(vec_int4 one, vec_int4 two) { return spu_sub(one, two); }
inline vec_ushort8 vec_sub(vec_ushort8 one, vec_ushort8 two) { return spu_sub(one, two); }
inline vec_short8 vec_sub(vec_short8 one, vec_short8 two) { return spu_sub(one, two); }
template <class Vector>
inline Vector vec_adds(Vector one, Vector two) {
  using Number = softcell_vmx::Lane<Vector>;
  return softcell_vmx::of_lanes<Vector>([&](int lane) {
    return softcell_vmx::saturated<Number>((long long)spu_extract(one, lane) + spu_extract(two, lane));
  });
}
template <class Vector>
inline Vector vec_subs(Vector one, Vector two) {
  using Number = softcell_vmx::Lane<Vector>;
  return softcell_vmx::of_lanes<Vector>([&](int lane) {
    return softcell_vmx::saturated<Number>((long long)spu_extract(one, lane) - spu_extract(two, lane));
  });
}
template <class Vector>
inline Vector vec_min(Vector one, Vector two) {
  return spu_sel(one, two, spu_cmpgt(one, two));
}
template <class Vector>
inline Vector vec_max(Vector one, Vector two) {
  return spu_sel(two, one, spu_cmpgt(one, two));
}
template <class Vector>
inline Vector vec_avg(Vector one, Vector two) {
  return softcell_vmx::of_lanes<Vector>(
      [&](int lane) { return ((long long)spu_extract(one, lane) + spu_extract(two, lane) + 1) >> 1; });
}
template <class Vector>
inline Vector vec_abs(Vector v_) {
  return softcell_vmx::of_lanes<Vector>([&](int lane) {
    return spu_extract(v_, lane) < 0 ? 0 - spu_extract(v_, lane) : spu_extract(v_, lane);
  });
}
inline vec_float4 vec_abs(vec_float4 v_) { return (vec_float4)spu_and((vec_uint4)v_, 0x7FFFFFFFu); }
template <class Vector>
inline Vector vec_abss(Vector v_) {
  using Number = softcell_vmx::Lane<Vector>;
  return softcell_vmx::of_lanes<Vector>([&](int lane) {
    const long long number = spu_extract(v_, lane);
    return softcell_vmx::saturated<Number>(number < 0 ? -number : number);
  });
}
inline vec_float4 vec_madd(vec_float4 one, vec_float4 two, vec_float4 three) {
  return spu_madd(one, two, three);
}
inline vec_float4 vec_nmsub(vec_float4 one, vec_float4 two, vec_float4 three) {
  return spu_nmsub(one, two, three);
}
/// Of eight products the lower halves, plus a number each.
template <class First, class Second, class Third>
inline typename softcell_vmx::Joined<First, Second>::Type vec_mladd(First one, Second two, Third three) {
  using Result = typename softcell_vmx::Joined<First, Second>::Type;
  return softcell_vmx::of_lanes<Result>([&](int lane) {
    return (unsigned int)spu_extract(one, lane) * (unsigned int)spu_extract(two, lane) +
           (unsigned int)spu_extract(three, lane);
  });
}
inline vec_short8 vec_madds(vec_short8 one, vec_short8 two, vec_short8 three) {
  return softcell_vmx::of_lanes<vec_short8>([&](int lane) {
    return softcell_vmx::saturated<short>((spu_extract(one, lane) * spu_extract(two, lane) >> 15) +
                                          spu_extract(three, lane));
  });
}
inline vec_short8 vec_mradds(vec_short8 one, vec_short8 two, vec_short8 three) {
  return softcell_vmx::of_lanes<vec_short8>([&](int lane) {
    return softcell_vmx::saturated<short>(((spu_extract(one, lane) * spu_extract(two, lane) + 0x4000) >> 15) +
                                          spu_extract(three, lane));
  });
}
inline vec_int4 vec_mule(vec_short8 one, vec_short8 two) { return spu_mule(one, two); }
inline vec_uint4 vec_mule(vec_ushort8 one, vec_ushort8 two) { return spu_mule(one, two); }
inline vec_int4 vec_mulo(vec_short8 one, vec_short8 two) { return spu_mulo(one, two); }
inline vec_uint4 vec_mulo(vec_ushort8 one, vec_ushort8 two) { return spu_mulo(one, two); }
#define SC_VMX_BYTE_PRODUCTS(name, first, Bytes, Halves)                                                    \
  inline Halves name(Bytes one, Bytes two) {                                                                \
    return softcell_vmx::of_lanes<Halves>(                                                                  \
        [&](int lane) { return spu_extract(one, 2 * lane + first) * spu_extract(two, 2 * lane + first); }); \
  }
SC_VMX_BYTE_PRODUCTS(vec_mule, 0, vec_uchar16, vec_ushort8)
SC_VMX_BYTE_PRODUCTS(vec_mule, 0, vec_char16, vec_short8)
SC_VMX_BYTE_PRODUCTS(vec_mulo, 1, vec_uchar16, vec_ushort8)
SC_VMX_BYTE_PRODUCTS(vec_mulo, 1, vec_char16, vec_short8)
#undef SC_VMX_BYTE_PRODUCTS

inline vec_float4 vec_re(vec_float4 v_) {
  const vec_float4 estimate = spu_re(v_);
  return estimate;
}
inline vec_float4 vec_rsqrte(vec_float4 v_) { return spu_rsqrte(v_); }
/* Whole numbers: what is 2^23 and more is one. */
inline vec_float4 vec_trunc(vec_float4 v_) {
  const vec_float4 whole = spu_convtf(spu_convts(v_, 0), 0);
  const vec_uint4 small = spu_cmpabsgt(spu_splats(8388608.0f), v_);
  return spu_sel(v_, spu_or(whole, (vec_float4)spu_and((vec_uint4)v_, 0x80000000u)), small);
}
inline vec_float4 vec_floor(vec_float4 v_) {
  const vec_float4 whole = vec_trunc(v_);
  return spu_sel(whole, spu_sub(whole, spu_splats(1.0f)), spu_cmpgt(whole, v_));
}
inline vec_float4 vec_ceil(vec_float4 v_) {
  const vec_float4 whole = vec_trunc(v_);
  return spu_sel(whole, spu_add(whole, spu_splats(1.0f)), spu_cmpgt(v_, whole));
}
/// Of halves the even one.
inline vec_float4 vec_round(vec_float4 v_) {
  const vec_float4 floor = vec_floor(v_), rest = spu_sub(v_, floor), half = spu_splats(0.5f);
  const vec_uint4 is_odd = spu_cmpeq(spu_and((vec_uint4)spu_convts(floor, 0), 1u), 1u);
  const vec_uint4 up = spu_or(spu_cmpgt(rest, half), spu_and(spu_cmpeq(rest, half), is_odd));
  return spu_sel(floor, spu_add(floor, spu_splats(1.0f)), up);
}
/* The scale is a constant. */
#define vec_ctf(vector_, scale) spu_convtf(vector_, scale)
#define vec_vcfsx(vector_, scale) spu_convtf((vec_int4)(vector_), scale)
#define vec_vcfux(vector_, scale) spu_convtf((vec_uint4)(vector_), scale)
#define vec_cts(vector_, scale) spu_convts(vector_, scale)
#define vec_ctu(vector_, scale) spu_convtu(vector_, scale)

// ---- bits

#define SC_VMX_LOGIC(name, operation)                                                     \
  template <class First, class Second>                                                    \
  inline typename softcell_vmx::Joined<First, Second>::Type name(First one, Second two) { \
    using Result = typename softcell_vmx::Joined<First, Second>::Type;                    \
    return (Result)operation((vec_uint4)one, (vec_uint4)two);                             \
  }
SC_VMX_LOGIC(vec_and, spu_and)
SC_VMX_LOGIC(vec_andc, spu_andc)
SC_VMX_LOGIC(vec_or, spu_or)
SC_VMX_LOGIC(vec_nor, spu_nor)
SC_VMX_LOGIC(vec_xor, spu_xor)
#undef SC_VMX_LOGIC

/* Counts modulo the lane's width. */
#define SC_VMX_SHIFT(name, expression)                               \
  template <class Vector>                                            \
  inline Vector name(Vector v_, softcell_vmx::Mask<Vector> counts) { \
    using Unsigned = softcell_vmx::Lane<softcell_vmx::Mask<Vector>>; \
    constexpr unsigned int kBits = 8 * sizeof(Unsigned);             \
    return softcell_vmx::of_lanes<Vector>([&](int lane) {            \
      const auto number = spu_extract(v_, lane);                     \
      const unsigned int count = spu_extract(counts, lane) % kBits;  \
      const unsigned long long bits = (Unsigned)number;              \
      (void)bits;                                                    \
      return (softcell_vmx::Lane<Vector>)(expression);               \
    });                                                              \
  }
SC_VMX_SHIFT(vec_sl, bits << count)
SC_VMX_SHIFT(vec_sr, bits >> count)
SC_VMX_SHIFT(vec_sra, (long long)number >> count)
SC_VMX_SHIFT(vec_rl, bits << count | bits >> (kBits - count))
#undef SC_VMX_SHIFT

template <class Vector, class Bits>
inline Vector vec_sel(Vector one, Vector two, Bits mask) {
  return (Vector)spu_sel((vec_uint4)one, (vec_uint4)two, (vec_uint4)mask);
}

// ---- places

template <class Vector>
inline Vector vec_perm(Vector one, Vector two, vec_uchar16 pattern) {
  return (Vector)spu_shuffle((vec_uchar16)one, (vec_uchar16)two, spu_and(pattern, (unsigned char)0x1F));
}
template <class Vector>
inline Vector vec_sld(Vector one, Vector two, int bytes) {
  const vec_uchar16 first = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  return vec_perm(one, two, vec_add(first, spu_splats((unsigned char)(bytes & 15))));
}
template <class Vector>
inline Vector vec_slo(Vector v_, vec_uchar16 count) {
  return spu_slqwbyte(v_, (unsigned int)(spu_extract(count, 15) >> 3 & 15));
}
template <class Vector>
inline Vector vec_sro(Vector v_, vec_uchar16 count) {
  return spu_rlmaskqwbyte(v_, -(int)(spu_extract(count, 15) >> 3 & 15));
}
template <class Vector>
inline Vector vec_splat(Vector v_, int lane) {
  return spu_splats(spu_extract(v_, lane % softcell_vmx::Lanes<Vector>::kCount));
}
inline vec_char16 vec_splat_s8(int number) { return spu_splats((signed char)number); }
inline vec_uchar16 vec_splat_u8(int number) { return spu_splats((unsigned char)number); }
inline vec_short8 vec_splat_s16(int number) { return spu_splats((short)number); }
inline vec_ushort8 vec_splat_u16(int number) { return spu_splats((unsigned short)number); }
inline vec_int4 vec_splat_s32(int number) { return spu_splats(number); }
inline vec_uint4 vec_splat_u32(int number) { return spu_splats((unsigned int)number); }
template <class Vector>
inline Vector vec_mergeh(Vector one, Vector two) {
  return softcell_vmx::of_lanes<Vector>(
      [&](int lane) { return spu_extract((lane & 1) == 0 ? one : two, lane / 2); });
}
template <class Vector>
inline Vector vec_mergel(Vector one, Vector two) {
  constexpr int kHalf = softcell_vmx::Lanes<Vector>::kCount / 2;
  return softcell_vmx::of_lanes<Vector>(
      [&](int lane) { return spu_extract((lane & 1) == 0 ? one : two, kHalf + lane / 2); });
}
inline vec_uchar16 vec_pack(vec_ushort8 one, vec_ushort8 two) {
  return softcell_vmx::packed<vec_uchar16>(one, two);
}
inline vec_char16 vec_pack(vec_short8 one, vec_short8 two) {
  return softcell_vmx::packed<vec_char16>(one, two);
}
inline vec_ushort8 vec_pack(vec_uint4 one, vec_uint4 two) {
  return softcell_vmx::packed<vec_ushort8>(one, two);
}
inline vec_short8 vec_pack(vec_int4 one, vec_int4 two) { return softcell_vmx::packed<vec_short8>(one, two); }
inline vec_uchar16 vec_packs(vec_ushort8 one, vec_ushort8 two) {
  return softcell_vmx::packed_saturated<vec_uchar16>(one, two);
}
inline vec_char16 vec_packs(vec_short8 one, vec_short8 two) {
  return softcell_vmx::packed_saturated<vec_char16>(one, two);
}
inline vec_ushort8 vec_packs(vec_uint4 one, vec_uint4 two) {
  return softcell_vmx::packed_saturated<vec_ushort8>(one, two);
}
inline vec_short8 vec_packs(vec_int4 one, vec_int4 two) {
  return softcell_vmx::packed_saturated<vec_short8>(one, two);
}
template <class Vector>
inline auto vec_packsu(Vector one, Vector two) {
  using Narrow = typename softcell_vmx::MaskOf<sizeof(softcell_vmx::Lane<Vector>) / 2>::Type;
  return softcell_vmx::packed_saturated<Narrow>(one, two);
}
inline vec_short8 vec_unpackh(vec_char16 v_) {
  return softcell_vmx::of_lanes<vec_short8>([&](int lane) { return spu_extract(v_, lane); });
}
inline vec_int4 vec_unpackh(vec_short8 v_) {
  return softcell_vmx::of_lanes<vec_int4>([&](int lane) { return spu_extract(v_, lane); });
}
inline vec_short8 vec_unpackl(vec_char16 v_) {
  return softcell_vmx::of_lanes<vec_short8>([&](int lane) { return spu_extract(v_, 8 + lane); });
}
inline vec_int4 vec_unpackl(vec_short8 v_) {
  return softcell_vmx::of_lanes<vec_int4>([&](int lane) { return spu_extract(v_, 4 + lane); });
}

// ---- comparisons

template <class Vector>
inline softcell_vmx::Mask<Vector> vec_cmpeq(Vector one, Vector two) {
  return spu_cmpeq(one, two);
}
template <class Vector>
inline softcell_vmx::Mask<Vector> vec_cmpgt(Vector one, Vector two) {
  return spu_cmpgt(one, two);
}
template <class Vector>
inline softcell_vmx::Mask<Vector> vec_cmplt(Vector one, Vector two) {
  return spu_cmpgt(two, one);
}
template <class Vector>
inline softcell_vmx::Mask<Vector> vec_cmpge(Vector one, Vector two) {
  const softcell_vmx::Mask<Vector> less = spu_cmpgt(two, one);
  return spu_nor(less, less);
}
template <class Vector>
inline softcell_vmx::Mask<Vector> vec_cmple(Vector one, Vector two) {
  return vec_cmpge(two, one);
}
#define SC_VMX_PREDICATES(name, all, any)             \
  template <class Vector>                             \
  inline int vec_all_##name(Vector one, Vector two) { \
    return all;                                       \
  }                                                   \
  template <class Vector>                             \
  inline int vec_any_##name(Vector one, Vector two) { \
    return any;                                       \
  }
SC_VMX_PREDICATES(eq, softcell_vmx::are_all(vec_cmpeq(one, two)), softcell_vmx::is_any(vec_cmpeq(one, two)))
SC_VMX_PREDICATES(ne, !softcell_vmx::is_any(vec_cmpeq(one, two)), !softcell_vmx::are_all(vec_cmpeq(one, two)))
SC_VMX_PREDICATES(gt, softcell_vmx::are_all(vec_cmpgt(one, two)), softcell_vmx::is_any(vec_cmpgt(one, two)))
SC_VMX_PREDICATES(ge, softcell_vmx::are_all(vec_cmpge(one, two)), softcell_vmx::is_any(vec_cmpge(one, two)))
SC_VMX_PREDICATES(lt, softcell_vmx::are_all(vec_cmplt(one, two)), softcell_vmx::is_any(vec_cmplt(one, two)))
SC_VMX_PREDICATES(le, softcell_vmx::are_all(vec_cmple(one, two)), softcell_vmx::is_any(vec_cmple(one, two)))
/* Floats are numbers here, so what is not less is greater or equal. */
SC_VMX_PREDICATES(nlt, vec_all_ge(one, two), vec_any_ge(one, two))
SC_VMX_PREDICATES(nle, vec_all_gt(one, two), vec_any_gt(one, two))
SC_VMX_PREDICATES(ngt, vec_all_le(one, two), vec_any_le(one, two))
SC_VMX_PREDICATES(nge, vec_all_lt(one, two), vec_any_lt(one, two))
#undef SC_VMX_PREDICATES
inline int vec_all_nan(vec_float4) { return 0; }
inline int vec_any_nan(vec_float4) { return 0; }
inline int vec_all_numeric(vec_float4) { return 1; }
inline int vec_any_numeric(vec_float4) { return 1; }
/// Whether the first lies within the second's sizes, in each lane.
inline int vec_all_in(vec_float4 v_, vec_float4 bounds) {
  return vec_all_le(v_, bounds) && vec_all_ge(v_, spu_sub(spu_splats(0.0f), bounds));
}
inline int vec_any_out(vec_float4 v_, vec_float4 bounds) { return !vec_all_in(v_, bounds); }

// ---- the local store: the quadword in which the byte lies, and its parts

template <class Scalar>
inline typename softcell_vmx::VectorOf<Scalar>::Type vec_ld(int offset, const Scalar* base) {
  return *(const typename softcell_vmx::VectorOf<Scalar>::Type*)softcell_vmx::quadword_at(offset, base);
}
template <class Scalar>
inline typename softcell_vmx::VectorOf<Scalar>::Type vec_ldl(int offset, const Scalar* base) {
  return vec_ld(offset, base);
}
template <class Scalar>
inline typename softcell_vmx::VectorOf<Scalar>::Type vec_lde(int offset, const Scalar* base) {
  return vec_ld(offset, base);
}
template <class Vector, class Scalar>
inline void vec_st(Vector v_, int offset, Scalar* base) {
  *(Vector*)softcell_vmx::quadword_at(offset, base) = v_;
}
template <class Vector, class Scalar>
inline void vec_stl(Vector v_, int offset, Scalar* base) {
  vec_st(v_, offset, base);
}
/// The element of the vector that has the place of the address in its quadword.
template <class Vector, class Scalar>
inline void vec_ste(Vector v_, int offset, Scalar* base) {
  const __UINTPTR_TYPE__ place = ((__UINTPTR_TYPE__)base + offset) & ~(__UINTPTR_TYPE__)(sizeof(Scalar) - 1);
  *(Scalar*)place = (Scalar)spu_extract(v_, (int)(place % 16 / sizeof(Scalar)));
}
template <class Scalar>
inline vec_uchar16 vec_lvsl(int offset, const Scalar* base) {
  const unsigned char first = (unsigned char)(((__UINTPTR_TYPE__)base + offset) & 15);
  return softcell_vmx::of_lanes<vec_uchar16>([&](int lane) { return first + lane; });
}
template <class Scalar>
inline vec_uchar16 vec_lvsr(int offset, const Scalar* base) {
  const unsigned char first = (unsigned char)(16 - (((__UINTPTR_TYPE__)base + offset) & 15));
  return softcell_vmx::of_lanes<vec_uchar16>([&](int lane) { return first + lane; });
}
/// From the address to the end of its quadword, then zeros.
template <class Scalar>
inline typename softcell_vmx::VectorOf<Scalar>::Type vec_lvlx(int offset, const Scalar* base) {
  return spu_slqwbyte(vec_ld(offset, base), (unsigned int)(((__UINTPTR_TYPE__)base + offset) & 15));
}
/// From the beginning of the address's quadword to the address, at the end of the vector.
template <class Scalar>
inline typename softcell_vmx::VectorOf<Scalar>::Type vec_lvrx(int offset, const Scalar* base) {
  return spu_rlmaskqwbyte(vec_ld(offset, base), (int)(((__UINTPTR_TYPE__)base + offset) & 15) - 16);
}

/* Hints for caches. */
#define vec_dst(address, control, stream) ((void)(address))
#define vec_dstt(address, control, stream) ((void)(address))
#define vec_dstst(address, control, stream) ((void)(address))
#define vec_dststt(address, control, stream) ((void)(address))
#define vec_dss(stream) ((void)0)
#define vec_dssall() ((void)0)

#endif
