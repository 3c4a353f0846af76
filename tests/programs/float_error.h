#pragma once
// How far a float function of the local store's math.h is from what is exact.

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>

namespace softcell::ls_sim {

inline constexpr double kUlps = 0.501;
inline constexpr double kUlpsOfOneArgument = 0.50005;  // spu_kernels/sdk/library/include/math.h

/// In units in the last place of what is exact, as math.h counts what a float cannot hold.
inline double error_of(float result, double exact) {
  if (std::isnan(exact)) exact = 0;  // not defined
  exact = std::clamp<double>(exact, -FLT_MAX, FLT_MAX);
  if (result == exact) return 0;
  const double size = std::fabs(exact);
  if (size < FLT_MIN)
    return result == 0 ? (size < 0x1.FFFFFFp-127 ? 0 : 1) : std::fabs(result - exact) * 0x1p149;
  // 2^(exponent - 23)
  const double unit = std::bit_cast<double>((std::bit_cast<std::uint64_t>(size) >> 52) << 52) * 0x1p-23;
  return std::fabs(result - exact) / unit;
}

}  // namespace softcell::ls_sim
