#pragma once
// Double precision: IEEE arithmetic on two lanes, each with its rounding mode, but for denormal operands, which are
// zero, and for NaN results, which are one NaN. Each function is one instruction.
// [SPU-ISA, double-precision instructions] documented; when the flags NAN and DENORM are set: assumed, from their names
//
// Ordinary numbers are computed in integers. The host computes all others, each lane by itself in the lane's mode; its
// own sticky flags become those of FPSCR.

#include "double_in_integers.h"
#include "fpscr.h"
#include "quadword.h"
#include "softcell/base/assert.h"

namespace softcell::ls_sim::interpreter::semantics {

inline constexpr std::uint64_t kDoubleSign = std::uint64_t{1} << 63, kDoubleInfinity = 0x7FF0000000000000,
                               kTheNan = 0x7FF8000000000000, kDoubleFraction = 0x000FFFFFFFFFFFFF;
inline constexpr std::uint32_t kTheSingleNan = 0x7FC00000;

inline std::uint64_t double_magnitude(std::uint64_t bits) { return bits & ~kDoubleSign; }
inline bool is_nan(std::uint64_t bits) { return double_magnitude(bits) > kDoubleInfinity; }
inline bool is_denormal(std::uint64_t bits) {
  return double_magnitude(bits) != 0 && double_magnitude(bits) <= kDoubleFraction;
}
/// An invalid product. A denormal counts as zero.
inline bool is_infinity_by_zero(std::uint64_t x, std::uint64_t y) {
  const std::uint64_t a = double_magnitude(x), b = double_magnitude(y);
  return (a == kDoubleInfinity && b <= kDoubleFraction) || (b == kDoubleInfinity && a <= kDoubleFraction);
}

/// @param lane  as the SPU counts.
inline std::uint64_t double_bits(Quadword q, int lane) { return ((U64x2)q)[1 - lane]; }
inline Quadword from_doubles(std::uint64_t lane0, std::uint64_t lane1) {
  return (Quadword)U64x2{lane1, lane0};
}

/// The host's control register for a lane: no exception is raised, denormal operands are zero.
inline std::uint32_t mxcsr_of_rounding(std::uint32_t rounding) {
  constexpr std::uint32_t kOfHost[] = {0, 3, 2, 1};  // nearest, towards zero, up, down
  return 0x1F80 | 0x0040 | kOfHost[rounding] << 13;
}

inline std::uint32_t double_flags(std::uint32_t mxcsr) {
  return ((mxcsr & kMxcsrOverflow) != 0 ? Fpscr::kDoubleOverflow : 0) |
         ((mxcsr & kMxcsrUnderflow) != 0 ? Fpscr::kDoubleUnderflow : 0) |
         ((mxcsr & kMxcsrInexact) != 0 ? Fpscr::kDoubleInexact : 0) |
         ((mxcsr & kMxcsrInvalid) != 0 ? Fpscr::kDoubleInvalid : 0);
}

/// Evaluates an operation of the host in the rounding mode of a lane.
/// @param operation  from three __m128d to one, in its low element.
/// @return  the result's low element. @param flags  receives those of the operation.
template <class Operation>
inline __m128d in_mode(std::uint32_t rounding, __m128d x, __m128d y, __m128d z, Operation&& operation,
                       std::uint32_t& flags) {
  const std::uint32_t before = _mm_getcsr();
  _mm_setcsr(mxcsr_of_rounding(rounding));
  asm volatile("" : "+x"(x), "+x"(y), "+x"(z));  // nothing is computed before the mode is set,
  __m128d result = operation(x, y, z);
  asm volatile("" : "+x"(result));  // nor after the flags were read
  flags |= double_flags(_mm_getcsr());
  _mm_setcsr(before);
  return result;
}

inline __m128d of_bits(std::uint64_t bits) { return (__m128d)U64x2{bits, 0}; }
inline std::uint64_t bits_of(__m128d value) { return ((U64x2)value)[0]; }

/// An operation written as x * y + z, by the bits of its doubles.
struct Fused {
  std::uint64_t x, y, z;
};

/// One lane of an operation on up to three operands; one that it lacks is given as zero.
/// @param as_fused  from three operands to a Fused; for a product z is a zero of its sign.
template <class AsFused>
std::uint64_t lane_of_double(int lane, std::uint64_t x, std::uint64_t y, std::uint64_t z, AsFused&& as_fused,
                             Fpscr& fpscr) {
  std::uint32_t flags = is_denormal(x) || is_denormal(y) || is_denormal(z) ? Fpscr::kDoubleDenormal : 0;
  const auto flushed = [](std::uint64_t bits) { return is_denormal(bits) ? bits & kDoubleSign : bits; };
  const Fused fused = as_fused(flushed(x), flushed(y), flushed(z));
  if (const auto rounded = fused_in_integers(fused.x, fused.y, fused.z, fpscr.rounding(lane))) {
    fpscr.set_double(lane, flags | (rounded->is_inexact ? Fpscr::kDoubleInexact : 0));
    return rounded->bits;
  }
  const std::uint64_t result = bits_of(in_mode(
      fpscr.rounding(lane), of_bits(fused.x), of_bits(fused.y), of_bits(fused.z),
      [](__m128d a, __m128d b, __m128d c) { return _mm_fmadd_sd(a, b, c); }, flags));
  // Not for the NaN of an invalid operation: IEEE 754 has the same one.
  if (is_nan(x) || is_nan(y) || is_nan(z)) flags |= Fpscr::kDoubleNan;
  // The host does not look at the product when the addend is a NaN.
  if (is_nan(z) && is_infinity_by_zero(x, y)) flags |= Fpscr::kDoubleInvalid;
  fpscr.set_double(lane, flags);
  return is_nan(result) ? kTheNan : result;
}

template <class AsFused>
Quadword both_doubles(const In& in, Quadword third, AsFused&& as_fused, Fpscr& fpscr) {
  const auto lane = [&](int i) {
    return lane_of_double(i, double_bits(in.a, i), double_bits(in.b, i), double_bits(third, i), as_fused,
                          fpscr);
  };
  return from_doubles(lane(0), lane(1));
}

inline constexpr std::uint64_t kDoubleOne = 0x3FF0000000000000;

inline Quadword dfa(const In& in, Fpscr& fpscr) {
  const auto as_fused = [](std::uint64_t x, std::uint64_t y, std::uint64_t) {
    return Fused{x, kDoubleOne, y};
  };
  return both_doubles(in, Quadword{}, as_fused, fpscr);
}
inline Quadword dfs(const In& in, Fpscr& fpscr) {
  const auto as_fused = [](std::uint64_t x, std::uint64_t y, std::uint64_t) {
    return Fused{x, kDoubleOne, y ^ kDoubleSign};
  };
  return both_doubles(in, Quadword{}, as_fused, fpscr);
}
inline Quadword dfm(const In& in, Fpscr& fpscr) {
  const auto as_fused = [](std::uint64_t x, std::uint64_t y, std::uint64_t) {
    return Fused{x, y, (x ^ y) & kDoubleSign};
  };
  return both_doubles(in, Quadword{}, as_fused, fpscr);
}
inline Quadword dfma(const In& in, Fpscr& fpscr) {
  const auto as_fused = [](std::uint64_t x, std::uint64_t y, std::uint64_t z) { return Fused{x, y, z}; };
  return both_doubles(in, in.t, as_fused, fpscr);
}
inline Quadword dfms(const In& in, Fpscr& fpscr) {
  const auto as_fused = [](std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    return Fused{x, y, z ^ kDoubleSign};
  };
  return both_doubles(in, in.t, as_fused, fpscr);
}

/// Negates what was rounded, but not a NaN.
inline Quadword negated(Quadword q) {
  const auto lane = [&](int i) {
    const std::uint64_t bits = double_bits(q, i);
    return is_nan(bits) ? bits : bits ^ kDoubleSign;
  };
  return from_doubles(lane(0), lane(1));
}
inline Quadword dfnms(const In& in, Fpscr& fpscr) { return negated(dfms(in, fpscr)); }
inline Quadword dfnma(const In& in, Fpscr& fpscr) { return negated(dfma(in, fpscr)); }

// ---- between single and double. Here singles are those of IEEE: infinities and NaN exist.

inline std::uint64_t single_to_double(std::uint32_t bits, int lane, Fpscr& fpscr) {
  const std::uint32_t magnitude = bits & 0x7FFFFFFFu;
  const std::uint64_t sign = std::uint64_t{bits & 0x80000000u} << 32;
  if (magnitude < 0x00800000u) {
    if (magnitude != 0) fpscr.set_double(lane, Fpscr::kDoubleDenormal);
    return sign;
  }
  if (magnitude > 0x7F800000u) {
    const bool is_quiet = (magnitude & 0x00400000u) != 0;
    fpscr.set_double(lane, Fpscr::kDoubleNan | (is_quiet ? 0 : Fpscr::kDoubleInvalid));
    return kTheNan;
  }
  if (magnitude == 0x7F800000u) return sign | kDoubleInfinity;
  return sign | ((std::uint64_t{magnitude} << 29) + (std::uint64_t{1023 - 127} << 52));
}
inline Quadword fesd(const In& in, Fpscr& fpscr) {
  const std::uint64_t lane0 = single_to_double(word(in.a, 0), 0, fpscr);
  return from_doubles(lane0, single_to_double(word(in.a, 2), 1, fpscr));
}

inline std::uint32_t double_to_single(std::uint64_t bits, int lane, Fpscr& fpscr) {
  if (const auto rounded = single_in_integers(bits, fpscr.rounding(lane))) {
    fpscr.set_double(lane, rounded->is_inexact ? Fpscr::kDoubleInexact : 0);
    return rounded->bits;
  }
  std::uint32_t flags = is_denormal(bits) ? Fpscr::kDoubleDenormal : 0;
  const __m128d rounded = in_mode(
      fpscr.rounding(lane), of_bits(bits), __m128d{}, __m128d{},
      [](__m128d x, __m128d, __m128d) { return (__m128d)_mm_cvtsd_ss(_mm_setzero_ps(), x); }, flags);
  const std::uint32_t single = ((U32x4)rounded)[0];
  const bool result_is_nan = (single & 0x7FFFFFFFu) > 0x7F800000u;
  if (result_is_nan) flags |= Fpscr::kDoubleNan;
  fpscr.set_double(lane, flags);
  return result_is_nan ? kTheSingleNan : single;
}
inline Quadword frds(const In& in, Fpscr& fpscr) {
  const std::uint32_t lane0 = double_to_single(double_bits(in.a, 0), 0, fpscr);
  return from_words(lane0, 0, double_to_single(double_bits(in.a, 1), 1, fpscr), 0);
}

// ---- compares of PowerXCell 8i; a PS3 has none of them

template <class Test>
Quadword mask_of_doubles(const In& in, Test&& test) {
  const auto lane = [&](int i) {
    return test(double_bits(in.a, i), double_bits(in.b, i)) ? ~std::uint64_t{0} : 0;
  };
  return from_doubles(lane(0), lane(1));
}
/// Numbers as signed integers in the same order, -0 and +0 being the same. @pre  no NaN
inline std::int64_t double_in_order(std::uint64_t bits) {
  SC_ASSERT(!is_nan(bits), "the bits {} are no number", bits);
  const auto magnitude = static_cast<std::int64_t>(double_magnitude(bits));
  return (bits & kDoubleSign) != 0 ? -magnitude : magnitude;
}
inline bool are_ordered(std::uint64_t x, std::uint64_t y) { return !is_nan(x) && !is_nan(y); }

inline Quadword dfceq(const In& in) {
  return mask_of_doubles(in, [](std::uint64_t x, std::uint64_t y) {
    return are_ordered(x, y) && double_in_order(x) == double_in_order(y);
  });
}
inline Quadword dfcgt(const In& in) {
  return mask_of_doubles(in, [](std::uint64_t x, std::uint64_t y) {
    return are_ordered(x, y) && double_in_order(x) > double_in_order(y);
  });
}
inline Quadword dfcmeq(const In& in) {
  return mask_of_doubles(in, [](std::uint64_t x, std::uint64_t y) {
    return are_ordered(x, y) && double_in_order(double_magnitude(x)) == double_in_order(double_magnitude(y));
  });
}
inline Quadword dfcmgt(const In& in) {
  return mask_of_doubles(in, [](std::uint64_t x, std::uint64_t y) {
    return are_ordered(x, y) && double_in_order(double_magnitude(x)) > double_in_order(double_magnitude(y));
  });
}
/// The bit of dftsv's immediate that stands for a value; 0 for an ordinary one.
inline std::int32_t special_value(std::uint64_t bits) {
  const bool is_negative = (bits & kDoubleSign) != 0;
  if (is_nan(bits)) return 0x40;
  if (double_magnitude(bits) == kDoubleInfinity) return is_negative ? 0x10 : 0x20;
  if (double_magnitude(bits) == 0) return is_negative ? 0x04 : 0x08;
  if (is_denormal(bits)) return is_negative ? 0x01 : 0x02;
  return 0;
}
inline Quadword dftsv(const In& in) {
  return mask_of_doubles(
      in, [&](std::uint64_t x, std::uint64_t) { return (special_value(x) & in.imm & 0x7F) != 0; });
}

}  // namespace softcell::ls_sim::interpreter::semantics
