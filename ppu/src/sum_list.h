#pragma once
// Writes the sum lists of the kernel `match` (match_job.h): which slots are added to make each slot.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

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

/// The list that makes the sums in the given order. A sum is made from the one before it where both differ by
/// at most one term that joins and one that leaves, unless a place that is a multiple of `restart` lies
/// between.
/// @pre  slots are at most kMaxSumSlot.
SumList write_sum_list(const std::vector<Sum>& sums, int restart);

inline constexpr std::uint32_t kMaxSumSlot = 10922;  ///< its offset still fits a halfword

}  // namespace softcell::ppu
