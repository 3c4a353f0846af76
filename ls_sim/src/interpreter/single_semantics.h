#pragma once
// Single precision: no infinities, no NaN, truncation. Each function is one instruction.
// [SPU-ISA, floating-point instructions] documented; estimates [tables read off consoles] second-hand
//
// An exponent field of 255 is an ordinary binade, denormals are zero, results are truncated, too large ones become the
// largest number, too small ones +0. The host computes the same, in its mode of truncation, unless an operand or the
// result has the exponent 255, is denormal, or leaves the range; the host's sticky flags tell. Only then the result
// comes from doubles, which is right always: the product of two 24-bit fractions is exact in 53 bits, a sum is
// truncated to 53 bits and then to 24, which is the same as to 24 at once.

#include "fpscr.h"
#include "quadword.h"

namespace softcell::ls_sim::interpreter::semantics {

// ---- four numbers as doubles

using D64x4 = double __attribute__((vector_size(32)));
using U64x4 = std::uint64_t __attribute__((vector_size(32)));
using S64x4 = std::int64_t __attribute__((vector_size(32)));

inline constexpr std::uint64_t kRebias = std::uint64_t{1023 - 127} << 52;
inline constexpr std::int64_t kSmallestNormal = 0x00800000, kFirstBeyondIeee = 0x7F800000,
                              kLargest = 0x7FFFFFFF;

/// The exact values of four numbers of the SPU.
inline D64x4 to_doubles(Quadword q) {
  const auto wide = (U64x4)_mm256_cvtepu32_epi64((__m128i)q);
  const U64x4 magnitude = wide & 0x7FFFFFFFu;
  const auto is_number = (U64x4)((S64x4)magnitude >= kSmallestNormal);
  const U64x4 sign = (wide >> 31) << 63;
  return (D64x4)(sign | (is_number & ((magnitude << 29) + kRebias)));
}

/// The low words of four doublewords.
inline Quadword low_words(U64x4 wide) {
  const __m256i gathered =
      _mm256_permutevar8x32_epi32((__m256i)wide, _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6));
  return (Quadword)_mm256_castsi256_si128(gathered);
}

/// Four exact or truncated values as numbers of the SPU.
/// @param flags  receives overflow, underflow and difference of each word.
inline Quadword to_singles(D64x4 values, Quadword& flags) {
  const auto bits = (U64x4)values;
  const U64x4 sign = bits >> 63 << 31;
  const S64x4 exact =
      (S64x4)((bits & ~(std::uint64_t{1} << 63)) >> 29) - static_cast<std::int64_t>(kRebias >> 29);
  const auto is_large = (U64x4)(exact > kLargest);
  const auto is_small = (U64x4)(exact < kSmallestNormal);
  const auto is_extended = (U64x4)(exact >= kFirstBeyondIeee);
  const auto is_not_zero = (U64x4)((bits << 1) != 0);
  const U64x4 magnitude = (is_large & static_cast<std::uint64_t>(kLargest)) | (~is_large & (U64x4)exact);
  flags = low_words((is_large & Fpscr::kOverflow) | (is_extended & Fpscr::kDifference) |
                    (is_small & is_not_zero & (Fpscr::kUnderflow | Fpscr::kDifference)));
  return low_words(~is_small & (sign | magnitude));
}

/// Operands that IEEE arithmetic would take for others: denormals, infinities, NaN.
inline Quadword is_unlike_ieee(Quadword q) {
  const Quadword magnitude = q & 0x7FFFFFFFu;
  const auto is_denormal = (Quadword)(magnitude - 1u < 0x007FFFFFu);
  return is_denormal | (Quadword)(magnitude >= 0x7F800000u);
}

inline void note_difference(Quadword& flags, Quadword operand) {
  flags |= is_unlike_ieee(operand) & Fpscr::kDifference;
}

// ---- add, subtract, multiply

/// @param host   the host's result.
/// @param exact  computes the result from doubles, and the flags.
template <class Exact>
inline Quadword checked_by_host(__m128 host, Exact&& exact, Fpscr& fpscr) {
  asm volatile("" : "+x"(host));  // the flags are those after the operation
  constexpr std::uint32_t kTelling = kMxcsrDenormal | kMxcsrOverflow | kMxcsrUnderflow;
  const auto bits = (Quadword)host;
  const __m128i is_special = (__m128i)((S32x4)(bits & 0x7FFFFFFFu) >= 0x7F800000);
  if (__builtin_expect((_mm_getcsr() & kTelling) != 0 || _mm_movemask_epi8(is_special) != 0, 0)) {
    Quadword flags{};
    const Quadword result = exact(flags);
    fpscr.bits |= flags;
    _mm_setcsr(kSpuMxcsr);
    return result;
  }
  return bits & (Quadword)((bits << 1) != 0);  // no -0
}

/// The value after every operation before it, so that a compiler leaves the order of rounding as it is.
inline D64x4 product(Quadword a, Quadword b) { return to_doubles(a) * to_doubles(b); }

inline Quadword fa(const In& in, Fpscr& fpscr) {
  return checked_by_host(
      _mm_add_ps((__m128)in.a, (__m128)in.b),
      [&](Quadword& flags) {
        const Quadword result = to_singles(to_doubles(in.a) + to_doubles(in.b), flags);
        note_difference(flags, in.a);
        note_difference(flags, in.b);
        return result;
      },
      fpscr);
}
inline Quadword fs(const In& in, Fpscr& fpscr) {
  return checked_by_host(
      _mm_sub_ps((__m128)in.a, (__m128)in.b),
      [&](Quadword& flags) {
        const Quadword result = to_singles(to_doubles(in.a) - to_doubles(in.b), flags);
        note_difference(flags, in.a);
        note_difference(flags, in.b);
        return result;
      },
      fpscr);
}
inline Quadword fm(const In& in, Fpscr& fpscr) {
  return checked_by_host(
      _mm_mul_ps((__m128)in.a, (__m128)in.b),
      [&](Quadword& flags) {
        const Quadword result = to_singles(product(in.a, in.b), flags);
        note_difference(flags, in.a);
        note_difference(flags, in.b);
        return result;
      },
      fpscr);
}

/// The exact part of a fused operation. @param sum  of the product and RC, in doubles.
template <class Sum>
Quadword fused(const In& in, Quadword& flags, Sum&& sum) {
  const Quadword result = to_singles(sum(product(in.a, in.b), to_doubles(in.c)), flags);
  note_difference(flags, in.a);
  note_difference(flags, in.b);
  note_difference(flags, in.c);
  return result;
}

inline Quadword fma(const In& in, Fpscr& fpscr) {
  return checked_by_host(
      _mm_fmadd_ps((__m128)in.a, (__m128)in.b, (__m128)in.c),
      [&](Quadword& flags) { return fused(in, flags, [](D64x4 ab, D64x4 c) { return ab + c; }); }, fpscr);
}
inline Quadword fms(const In& in, Fpscr& fpscr) {
  return checked_by_host(
      _mm_fmsub_ps((__m128)in.a, (__m128)in.b, (__m128)in.c),
      [&](Quadword& flags) { return fused(in, flags, [](D64x4 ab, D64x4 c) { return ab - c; }); }, fpscr);
}
inline Quadword fnms(const In& in, Fpscr& fpscr) {
  return checked_by_host(
      _mm_fnmadd_ps((__m128)in.a, (__m128)in.b, (__m128)in.c),
      [&](Quadword& flags) { return fused(in, flags, [](D64x4 ab, D64x4 c) { return c - ab; }); }, fpscr);
}

// ---- compares

/// Numbers as signed integers in the same order; denormals and -0 are 0.
inline S32x4 in_order(Quadword q) {
  const Quadword magnitude = q & 0x7FFFFFFFu;
  const auto number = (S32x4)(magnitude & (Quadword)(magnitude >= 0x00800000u));
  const S32x4 sign = (S32x4)q >> 31;
  return (number ^ sign) - sign;
}
inline Quadword without_sign(Quadword q) { return q & 0x7FFFFFFFu; }

inline Quadword fceq(const In& in) { return (Quadword)(in_order(in.a) == in_order(in.b)); }
inline Quadword fcgt(const In& in) { return (Quadword)(in_order(in.a) > in_order(in.b)); }
inline Quadword fcmeq(const In& in) {
  return (Quadword)(in_order(without_sign(in.a)) == in_order(without_sign(in.b)));
}
inline Quadword fcmgt(const In& in) {
  return (Quadword)(in_order(without_sign(in.a)) > in_order(without_sign(in.b)));
}

// ---- conversions. All steps are exact but the last, which truncates.

/// 2^exponent in each element. @param exponent  of a normal double.
inline D64x4 power_of_two(std::int32_t exponent) {
  const std::uint64_t bits = static_cast<std::uint64_t>(exponent + 1023) << 52;
  return (D64x4)U64x4{bits, bits, bits, bits};
}

inline Quadword converted_to_single(D64x4 value, std::int32_t imm, Fpscr& fpscr) {
  Quadword flags{};
  const Quadword result = to_singles(value * power_of_two(imm - 155), flags);
  fpscr.bits |= flags;
  return result;
}
inline Quadword csflt(const In& in, Fpscr& fpscr) {
  return converted_to_single((D64x4)_mm256_cvtepi32_pd((__m128i)in.a), in.imm, fpscr);
}
inline Quadword cuflt(const In& in, Fpscr& fpscr) {
  constexpr double kHalfRange = 2147483648.0;
  const D64x4 offset = (D64x4)_mm256_cvtepi32_pd((__m128i)(in.a ^ 0x80000000u));
  return converted_to_single(offset + kHalfRange, in.imm, fpscr);
}

inline __m128i truncated_to_words(D64x4 value) { return _mm256_cvttpd_epi32((__m256d)value); }
inline Quadword at_least(D64x4 value, double limit) {
  return low_words((U64x4)(value >= D64x4{limit, limit, limit, limit}));
}
inline D64x4 scaled_to_integer(const In& in) { return to_doubles(in.a) * power_of_two(173 - in.imm); }

inline Quadword cflts(const In& in) {
  const D64x4 value = scaled_to_integer(in);
  const Quadword is_too_large = at_least(value, 2147483648.0);
  // The host gives 0x80000000 for what does not fit, which is right below.
  return ((Quadword)truncated_to_words(value) & ~is_too_large) | (is_too_large & 0x7FFFFFFFu);
}
inline Quadword cfltu(const In& in) {
  const D64x4 value = scaled_to_integer(in);
  const Quadword is_upper_half = at_least(value, 2147483648.0), is_too_large = at_least(value, 4294967296.0);
  const Quadword is_positive = (Quadword)((S32x4)in.a >= 0);
  const auto lower = (Quadword)truncated_to_words(value);
  const Quadword upper = (Quadword)truncated_to_words(value - 2147483648.0) ^ 0x80000000u;
  return is_positive & (is_too_large | (is_upper_half & upper) | (~is_upper_half & lower));
}

// ---- estimates

/// Fractions of the estimates, base << 10 | step, by the first bits of the argument's fraction.
inline constexpr std::uint32_t kReciprocalFractions[32] = {
    0x7FFBE0, 0x7F87A6, 0x70EF72, 0x708B40, 0x638B12, 0x633AEA, 0x5792C4, 0x574AA0,
    0x4CCA7E, 0x4C9262, 0x430A44, 0x42D62A, 0x3A2E12, 0x39FDFA, 0x3215E4, 0x31F1D2,
    0x2AA9BE, 0x2A85AC, 0x23D59A, 0x23BD8E, 0x1D8576, 0x1D8576, 0x17AD5A, 0x17AD5A,
    0x124543, 0x124543, 0x0D392D, 0x0D392D, 0x08851A, 0x08851A, 0x041D07, 0x041D07};
inline constexpr std::uint32_t kRootFractions[64] = {
    // even exponents
    0x350160, 0x34E954, 0x2F993D, 0x2F993D, 0x2AA523, 0x2AA523, 0x26190D, 0x26190D, 0x21E4F9, 0x21E4F9,
    0x1E00E9, 0x1E00E9, 0x1A5CD9, 0x1A5CD9, 0x16F8CB, 0x16F8CB, 0x13CCC0, 0x13CCC0, 0x10CCB3, 0x10CCB3,
    0x0E00AA, 0x0E00AA, 0x0B58A1, 0x0B58A1, 0x08D498, 0x08D498, 0x067491, 0x067491, 0x043089, 0x043089,
    0x020C83, 0x020C83,
    // odd ones
    0x7FFDF4, 0x7FD1DE, 0x7859C8, 0x783DBA, 0x71559C, 0x71559C, 0x6AE57C, 0x6AE57C, 0x64F561, 0x64F561,
    0x5F7149, 0x5F7149, 0x5A4D33, 0x5A4D33, 0x55811F, 0x55811F, 0x51050F, 0x51050F, 0x4CC8FE, 0x4CC8FE,
    0x48D0F0, 0x48D0F0, 0x4510E4, 0x4510E4, 0x4180D7, 0x4180D7, 0x3E24CC, 0x3E24CC, 0x3AF4C3, 0x3AF4C3,
    0x37E8BA, 0x37E8BA};

inline std::uint32_t reciprocal_estimate(std::uint32_t x) {
  const std::uint32_t exponent = x >> 23 & 0xFF;
  const std::uint32_t of_result = exponent == 0 ? 255 : exponent > 253 ? 0 : 253 - exponent;
  return (x & 0x80000000u) | of_result << 23 | kReciprocalFractions[x >> 18 & 31];
}
inline std::uint32_t root_estimate(std::uint32_t x) {
  const std::uint32_t exponent = x >> 23 & 0xFF;
  const std::uint32_t of_result = exponent == 0 ? 255 : 190 - (exponent + 1) / 2;
  return of_result << 23 | kRootFractions[(exponent & 1) << 5 | (x >> 18 & 31)];
}

template <class Estimate>
Quadword estimated(Quadword q, Estimate&& estimate, Fpscr& fpscr) {
  const Quadword result{estimate(q[0]), estimate(q[1]), estimate(q[2]), estimate(q[3])};
  const auto is_zero = (Quadword)((q & 0x7F800000u) == 0);
  fpscr.set_divide_by_zero(static_cast<std::uint32_t>(_mm_movemask_ps((__m128)is_zero)));
  return result;
}
inline Quadword frest(const In& in, Fpscr& fpscr) { return estimated(in.a, reciprocal_estimate, fpscr); }
inline Quadword frsqest(const In& in, Fpscr& fpscr) { return estimated(in.a, root_estimate, fpscr); }

/// base - step * Y, truncated; RA is the estimate's argument, RB the estimate.
inline Quadword fi(const In& in) {
  const Quadword base = (in.b & 0x7FFC00u) << 9;
  const Quadword product = (in.b & 0x3FFu) * (in.a & 0x7FFFFu);
  const Quadword difference = base - product;
  const Quadword high = in.b & 0xFF800000u;
  const auto borrows = (Quadword)(product > base);  // never with the estimate of RA
  const Quadword usual = high | difference >> 9;
  const Quadword lower_binade = (high - 0x00800000u) | (difference >> 8 & 0x7FFFFFu);
  return (borrows & lower_binade) | (~borrows & usual);
}

// ---- the status register

inline Quadword fscrrd(const In&, Fpscr& fpscr) { return fpscr.bits; }
inline void fscrwr(const In& in, Fpscr& fpscr) { fpscr.bits = in.a & Fpscr::writable(); }

}  // namespace softcell::ls_sim::interpreter::semantics
