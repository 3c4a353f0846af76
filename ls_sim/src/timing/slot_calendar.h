#pragma once
// When a port or main memory is taken: time in slots of equal length, each free or taken.

#include <bit>
#include <cstdint>
#include <deque>

#include "softcell/base/assert.h"

namespace softcell::ls_sim {

/// A later request takes the first slot that is free, also between slots that earlier requests have taken. So commands of several SPEs
/// share a port, and no slot stays free while a command waits for one.
class SlotCalendar {
 public:
  /// The first free slot from `slot` on. Slots before those that were forgotten count as taken.
  std::uint64_t first_free(std::uint64_t slot) const {
    if (slot < begin_) slot = begin_;
    std::uint64_t word = (slot - begin_) / kBits;
    if (word >= words_.size()) return slot;
    std::uint64_t free = ~words_[word] & (~std::uint64_t{0} << ((slot - begin_) % kBits));
    while (free == 0) {
      if (++word >= words_.size()) return begin_ + word * kBits;
      free = ~words_[word];
    }
    return begin_ + word * kBits + static_cast<std::uint64_t>(std::countr_zero(free));
  }

  /// @pre the slot is free
  void take(std::uint64_t slot) {
    SC_ASSERT(first_free(slot) == slot, "slot {} is taken", slot);
    const std::uint64_t word = (slot - begin_) / kBits;
    if (word >= words_.size()) words_.resize(word + 1);
    words_[word] |= std::uint64_t{1} << ((slot - begin_) % kBits);
  }

  /// Frees the memory of slots before this one, for which no request will come.
  void forget_before(std::uint64_t slot) {
    while (!words_.empty() && begin_ + kBits <= slot) {
      words_.pop_front();
      begin_ += kBits;
    }
    if (words_.empty() && begin_ + kBits <= slot) begin_ = slot / kBits * kBits;
  }

 private:
  static constexpr std::uint64_t kBits = 64;

  std::uint64_t begin_ = 0;  ///< a multiple of kBits
  std::deque<std::uint64_t> words_;
};

}  // namespace softcell::ls_sim
