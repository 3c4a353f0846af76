#pragma once
// The floating-point status and control register, and the host's own that the arithmetic uses.

#include <xmmintrin.h>

#include <cstdint>

#include "quadword.h"

namespace softcell::ls_sim::interpreter {

/// 128 bits, of which words 0 and 3 hold flags of single precision, 1 and 2 also those of the two doubles.
/// All flags stay until fscrwr clears them. [SPU-ISA, floating-point status and control register] documented
struct Fpscr {
  Quadword bits{};

  /// What fscrwr can change.
  static Quadword writable() { return from_words(0xF07, 0x3F07, 0x3F07, 0xF07); }

  // Flags of single precision, in the last bits of each word.
  static constexpr std::uint32_t kOverflow = 4, kUnderflow = 2, kDifference = 1;
  // Flags of double precision, in words 1 and 2.
  static constexpr std::uint32_t kDoubleOverflow = 1u << 13, kDoubleUnderflow = 1u << 12,
                                 kDoubleInexact = 1u << 11, kDoubleInvalid = 1u << 10, kDoubleNan = 1u << 9,
                                 kDoubleDenormal = 1u << 8;

  /// frest or frsqest of zero: bits 20 to 23 of word 3 stand for words 0 to 3. @param lanes  bit j: host's word j
  void set_divide_by_zero(std::uint32_t lanes) { bits[0] |= lanes << 8; }

  /// @param lane  0 or 1, as the SPU counts doubles.
  void set_double(int lane, std::uint32_t flags) { bits[2 - lane] |= flags; }

  /// 0 nearest, 1 towards zero, 2 up, 3 down.
  std::uint32_t rounding(int lane) const { return bits[kPreferredWord] >> (lane == 0 ? 10 : 8) & 3; }
};

/// The host's MXCSR while SPU instructions execute: truncates, flushes results, raises nothing.
/// Denormal operands are not flushed, so that the host sets its sticky flag for them.
inline constexpr std::uint32_t kSpuMxcsr = 0x1F80 | 0x6000 | 0x8000;
inline constexpr std::uint32_t kMxcsrInvalid = 1, kMxcsrDenormal = 2, kMxcsrOverflow = 8,
                               kMxcsrUnderflow = 16, kMxcsrInexact = 32;

/// Sets the host's arithmetic for as long as it lives. What computes in that mode must be a function of its own
/// that is not inlined, since compilers move arithmetic across the change.
class SpuArithmetic {
 public:
  SpuArithmetic() : before_(_mm_getcsr()) { _mm_setcsr(kSpuMxcsr); }
  ~SpuArithmetic() { _mm_setcsr(before_); }
  SpuArithmetic(const SpuArithmetic&) = delete;
  SpuArithmetic& operator=(const SpuArithmetic&) = delete;

 private:
  std::uint32_t before_;
};

/// The host's usual arithmetic for as long as it lives, for what SPU instructions call.
class HostArithmetic {
 public:
  HostArithmetic() { _mm_setcsr(0x1F80); }
  ~HostArithmetic() { _mm_setcsr(kSpuMxcsr); }
  HostArithmetic(const HostArithmetic&) = delete;
  HostArithmetic& operator=(const HostArithmetic&) = delete;
};

}  // namespace softcell::ls_sim::interpreter
