#pragma once
// Writes sum lists (spu_kernels/sum_list_job.h): which slots are added to make each slot.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/lattice.h"
#include "sum_list_job.h"

namespace softcell::ppu {

/// One sum to be made.
struct Sum {
  std::array<int, 3> row;            ///< sums of equal row may follow one another in a chain
  int place;                         ///< along the row
  std::vector<std::uint32_t> terms;  ///< slots, ascending; one may come twice
};

/// Sums in the order in which they are made, slots 1, 2, 3, ..., with the rule for each.
struct SumLevel {
  struct Rule {
    bool follows = false;                 ///< made from the sum before it: that plus `joins` minus `leaves`
    std::uint32_t joins = 0, leaves = 0;  ///< slots; 0 for none
  };
  Csr terms;
  std::vector<Rule> rules;

  std::size_t size() const { return rules.size(); }
  /// Appends a sum that is always zero.
  void push_nothing() {
    terms.push(std::array<std::uint32_t, 1>{0});
    rules.emplace_back();
  }
};

/// A sum follows the one before it if the two differ by at most one term that joins and one that leaves, unless a place that is a multiple
/// of `restart` lies between.
SumLevel sum_level(const std::vector<Sum>& sums, int restart);

struct SumList {
  std::vector<std::uint16_t> halfwords;
  std::size_t additions = 0;  ///< and subtractions
};

/// Writes a list sum by sum. Slots are given as offsets; 0 is the slot that adds nothing.
class SumListWriter {
 public:
  /// Begins a chain with the sum of `terms`; empty: the sum is zero.
  void begin(std::span<const std::uint16_t> terms);
  /// The next sum in the chain of the last one.
  /// @pre  follows_chain()
  void follow(std::uint16_t joins, std::uint16_t leaves) {
    SC_ASSERT(follows_chain(), "a sum that joins {} and leaves {} follows none", joins, leaves);
    steps_.push_back({joins, leaves});
  }
  /// A sum that follows one from a chain of another list.
  void go_on(std::uint16_t before, std::uint16_t joins, std::uint16_t leaves);

  /// Whether the last sum belongs to a chain.
  bool follows_chain() const { return !terms_.empty(); }

  /// Ends the list and returns it. @pre nothing is written afterwards
  SumList finish();

 private:
  struct Step {
    std::uint16_t joins, leaves;
  };
  void end_chain();
  void push(std::size_t halfword) { list_.halfwords.push_back(static_cast<std::uint16_t>(halfword)); }

  SumList list_;
  std::vector<std::uint16_t> terms_;  ///< of the current chain
  std::vector<Step> steps_;
  std::size_t run_at_ = 0;  ///< index of the current run's length; meaningless unless in_run_
  bool in_run_ = false;
};

/// How a list is written.
struct SumListFormat {
  std::uint32_t slot_bytes;  ///< a multiple of 4
  int restart;               ///< chains end before places that are a multiple of it

  constexpr std::uint32_t max_slot() const { return 0xFFFF / (slot_bytes / spu::kSumOffsetUnit); }
};

/// The offset of a slot in sum lists.
constexpr std::uint16_t sum_list_offset(std::uint32_t slot, std::uint32_t slot_bytes) {
  return static_cast<std::uint16_t>(slot * (slot_bytes / spu::kSumOffsetUnit));
}

/// The list that makes all sums of a level.
/// @pre  slots are at most SumListFormat::max_slot().
SumList write_sum_list(const SumLevel& level, std::uint32_t slot_bytes);

/// The same from sums.
inline SumList write_sum_list(const std::vector<Sum>& sums, const SumListFormat& format) {
  return write_sum_list(sum_level(sums, format.restart), format.slot_bytes);
}

}  // namespace softcell::ppu
