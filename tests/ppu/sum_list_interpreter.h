#pragma once
// What a kernel does with a sum list, without its arithmetic.

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "sum_list_job.h"

namespace softcell::ppu::test {

using Slots = std::vector<double>;  // one number stands for a payload

inline Slots run_sum_list(const std::uint16_t* list, const Slots& in, std::size_t slots,
                          std::uint32_t slot_bytes) {
  const std::size_t units = slot_bytes / spu::kSumOffsetUnit;
  const auto at = [&](std::uint16_t offset) {
    EXPECT_EQ(offset % units, 0u);
    return in.at(offset / units);
  };
  Slots out(slots, 0.0);
  std::size_t next = 1;
  while (const std::uint16_t terms = *list++) {
    std::uint16_t growing = *list++, sliding = *list++, shrinking = *list++;
    double sum = 0;
    for (std::uint16_t i = 0; i < terms; ++i) sum += at(*list++);
    out.at(next++) = sum;
    for (; growing != 0; --growing) out.at(next++) = sum += at(*list++);
    for (; sliding != 0; --sliding, list += 2) out.at(next++) = sum += at(list[0]) - at(list[1]);
    for (; shrinking != 0; --shrinking) out.at(next++) = sum -= at(*list++);
  }
  return out;
}

}  // namespace softcell::ppu::test
