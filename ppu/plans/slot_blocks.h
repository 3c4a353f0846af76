#pragma once
// Allocates slots of a local store in blocks, and frees them after their last use.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "softcell/base/assert.h"

namespace softcell::ppu {

/// Allocates first fit. Calls must come in the order of time.
class SlotBlocks {
 public:
  /// Slot 0 is never allocated: it is always zero. A block may be empty.
  /// @return  the number of the block's first slot
  std::uint32_t allocate(std::uint32_t count, int last_use) {
    SC_ASSERT(blocks_.empty() || blocks_.back().end <= most_, "the last block ends at {}, past all {} slots",
              blocks_.back().end, most_);
    std::uint32_t begin = 1;
    auto before = blocks_.begin();
    for (; before != blocks_.end() && before->begin < begin + count; ++before) begin = before->end;
    blocks_.insert(before, {begin, begin + count, last_use});
    most_ = std::max(most_, begin + count);
    return begin;
  }

  /// Frees the blocks whose last use was before `time`.
  void free_before(int time) {
    std::erase_if(blocks_, [&](const Block& block) { return block.last_use < time; });
  }

  std::uint32_t most() const { return most_; }  ///< the most slots that were ever needed, slot 0 included

 private:
  struct Block {
    std::uint32_t begin, end;
    int last_use;
  };
  std::vector<Block> blocks_;  // ascending
  std::uint32_t most_ = 1;
};

}  // namespace softcell::ppu
