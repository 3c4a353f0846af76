#pragma once
// Writes sum lists (spu_kernels/sum_list_job.h): which slots are added to make each slot.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sum_list_job.h"

namespace softcell::ppu {

/// One sum to be made.
struct Sum {
  std::array<int, 3> row;            ///< sums of equal row may follow one another in a chain
  int place;                         ///< along the row
  std::vector<std::uint32_t> terms;  ///< slots, ascending; one may come twice
};

struct SumList {
  std::vector<std::uint16_t> halfwords;
  std::size_t additions = 0;  ///< and subtractions
};

/// How a list is written.
struct SumListFormat {
  std::uint32_t slot_bytes;  ///< a multiple of 8
  int restart;               ///< chains end before places that are a multiple of it

  constexpr std::uint32_t max_slot() const { return 0xFFFF / (slot_bytes / spu::kSumOffsetUnit); }
};

/// The list that makes the sums in the given order. A sum is made from the one before it where both differ by
/// at most one term that joins and one that leaves, unless a place where chains end lies between.
/// @pre  slots are at most format.max_slot().
SumList write_sum_list(const std::vector<Sum>& sums, const SumListFormat& format);

}  // namespace softcell::ppu
