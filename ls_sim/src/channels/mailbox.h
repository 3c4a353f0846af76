#pragma once
// A queue of words between an SPU and the outside, which writes to it or reads from it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "softcell/base/assert.h"

namespace softcell::ls_sim {

/// At most Depth words, first in, first out. Not thread safe: guarded by the SPEs' monitor.
template <std::size_t Depth>
class Mailbox {
 public:
  std::uint32_t count() const { return count_; }
  std::uint32_t free_slots() const { return static_cast<std::uint32_t>(Depth) - count_; }
  bool empty() const { return count_ == 0; }
  bool full() const { return count_ == Depth; }

  /// Into a full mailbox, the word replaces the newest. [CBEA, SPU inbound mailbox] documented
  void write(std::uint32_t value) {
    if (!full()) ++count_;
    words_[(first_ + count_ - 1) % Depth] = value;
  }

  std::optional<std::uint32_t> read() {
    if (empty()) return std::nullopt;
    SC_ASSERT(first_ < Depth && count_ <= Depth, "word {} of {} in a mailbox of {}", first_, count_, Depth);
    const std::uint32_t value = words_[first_];
    first_ = static_cast<std::uint32_t>((first_ + 1) % Depth);
    --count_;
    return value;
  }

 private:
  std::array<std::uint32_t, Depth> words_{};
  std::uint32_t first_ = 0, count_ = 0;
};

}  // namespace softcell::ls_sim
