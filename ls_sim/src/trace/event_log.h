#pragma once

#include <cstddef>
#include <memory>
#include <vector>

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
    (*this)[size_] = event;
    return size_++;
  }

  Event& operator[](std::size_t index) { return chunks_[index / kChunk][index % kChunk]; }
  const Event& operator[](std::size_t index) const { return chunks_[index / kChunk][index % kChunk]; }
  std::size_t size() const { return size_; }
  std::size_t dropped() const { return dropped_; }

  static constexpr std::size_t kDropped = static_cast<std::size_t>(-1);

 private:
  static constexpr std::size_t kChunk = 8192;

  void grow() { chunks_.push_back(std::make_unique_for_overwrite<Event[]>(kChunk)); }

  std::size_t most_, size_ = 0, dropped_ = 0;
  std::vector<std::unique_ptr<Event[]>> chunks_;
};

}  // namespace softcell::ls_sim
