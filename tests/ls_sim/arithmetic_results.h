#pragma once
// Derives from the results of the kernel `arithmetic` in which arithmetic mode it ran.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

namespace softcell::ls_sim {

/// Eight vectors, each with four equal lanes: four results when the kernel begins, then the same four after it has called channels.
using ArithmeticResults = std::array<std::array<float, 4>, 8>;

/// @param below_one  result of 1 minus a tiny number  @param above_minus_one  result of -1 plus a tiny number
inline std::string rounding_of(float below_one, float above_minus_one) {
  const bool less = below_one == std::nextafterf(1, 0), more = above_minus_one == std::nextafterf(-1, 0);
  if (!(less || below_one == 1) || !(more || above_minus_one == -1)) return "as no host does";
  if (less) return more ? "toward zero" : "downward";
  return more ? "upward" : "to the nearest number";
}

/// Expects the single precision of an SPU, which truncates and treats denormal results and operands as zero.
/// [SPU ISA, single precision] documented
inline void expect_arithmetic_of_an_spu(const ArithmeticResults& results) {
  for (const std::size_t first : {0u, 4u}) {
    const std::string kernel = first == 0 ? "a kernel that begins" : "a kernel that has called out";
    const auto [below_one, above_minus_one, result, operand] =
        std::array{results[first][0], results[first + 1][0], results[first + 2][0], results[first + 3][0]};
    EXPECT_EQ(kernel + " rounds " + rounding_of(below_one, above_minus_one), kernel + " rounds toward zero")
        << "the native engine's rounding mode is wrong: an SPU truncates";
    EXPECT_EQ(result, 0) << kernel << " keeps a denormal result; an SPU makes it zero";
    EXPECT_EQ(operand, 0) << kernel << " computes with a denormal operand; an SPU takes it for zero";
  }
}

}  // namespace softcell::ls_sim
