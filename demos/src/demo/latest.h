#pragma once
// Hands the newest of a thread's values to another thread, neither of which waits for the other.

#include <array>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace softcell::demos {

/// Three copies: one that the writer fills, one that the reader reads, and the newest that is complete.
/// Values that nobody has read are overwritten. One writer and one reader.
template <class Value>
class Latest {
 public:
  // The writer's side.

  /// To be filled; it has whatever an earlier one had.
  Value& next() { return values_[writing_]; }
  /// Makes next() the newest.
  void publish() {
    {
      const std::lock_guard lock(mutex_);
      std::swap(writing_, newest_);
      is_new_ = true;
    }
    changed_.notify_one();
  }
  /// Ends the reader's wait(): there will be no more.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_one();
  }

  // The reader's side.

  /// The newest there was at the last update() or wait().
  const Value& current() const { return values_[reading_]; }
  void update() {
    const std::lock_guard lock(mutex_);
    take();
  }
  /// Until something is published that was not current yet. @return false: closed
  bool wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_new_ || closed_; });
    if (closed_) return false;
    take();
    return true;
  }

 private:
  void take() {
    if (is_new_) std::swap(reading_, newest_);
    is_new_ = false;
  }

  std::array<Value, 3> values_{};
  std::size_t writing_ = 0, newest_ = 1, reading_ = 2;
  bool is_new_ = false, closed_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
};

}  // namespace softcell::demos
