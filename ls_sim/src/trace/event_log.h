#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "softcell/base/assert.h"

namespace softcell::ls_sim {

/// Events in order, appended at the cost of writing them: memory grows by whole chunks, and what is recorded
/// never moves. Past its limit it only counts.
template <typename Event>
class EventLog {
 public:
  explicit EventLog(std::size_t most) : most_(most) { grow(); }

  /// @return  the event's index, or kDropped.
  std::size_t append(const Event& event) {
    if (size_ == most_) {
      ++dropped_;
      return kDropped;
    }
    if (size_ == chunks_.size() * kChunk) grow();
    const std::size_t index = size_++;
    (*this)[index] = event;
    return index;
  }

  Event& operator[](std::size_t index) { return at(*this, index); }
  const Event& operator[](std::size_t index) const { return at(*this, index); }
  std::size_t size() const { return size_; }
  std::size_t dropped() const { return dropped_; }

  static constexpr std::size_t kDropped = static_cast<std::size_t>(-1);

 private:
  static constexpr std::size_t kChunk = 8192;
  template <typename Log>
  static auto& at(Log& log, std::size_t index) {
    SC_ASSERT(index < log.size_, "event {} of {}, {} dropped", index, log.size_, log.dropped_);
    return log.chunks_[index / kChunk][index % kChunk];
  }

  void grow() {
    SC_ASSERT(size_ == chunks_.size() * kChunk, "a log of {} events grows beyond {} chunks", size_,
              chunks_.size());
    chunks_.push_back(std::make_unique_for_overwrite<Event[]>(kChunk));
  }

  std::size_t most_, size_ = 0, dropped_ = 0;
  std::vector<std::unique_ptr<Event[]>> chunks_;
};

}  // namespace softcell::ls_sim
