#pragma once
// Passes the newest value from one thread to another. Neither thread waits for the other.

#include <array>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::demos {

/// Three copies: one that the writer fills, one that the reader reads, and the newest that is complete.
/// Values that nobody has read are overwritten. One writer and one reader.
template <class Value>
class Latest {
 public:
  // The writer's side.

  /// The copy that the writer fills next; it still holds an earlier value.
  Value& next() { return values_[writing_]; }
  /// Makes next() the newest.
  void publish() {
    {
      const std::lock_guard lock(mutex_);
      SC_ASSERT(!closed_, "copy {} is published behind the last", writing_);
      std::swap(writing_, newest_);
      is_new_ = true;
    }
    changed_.notify_one();
  }
  /// Ends the reader's wait(): the writer publishes nothing more.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_one();
  }

  // The reader's side.

  /// The value that was the newest at the last update() or wait().
  const Value& current() const { return values_[reading_]; }
  void update() {
    const std::lock_guard lock(mutex_);
    fetch();
  }
  /// Waits for a value that is newer than current(). @return false: the writer has called close()
  bool wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_new_ || closed_; });
    if (closed_) return false;
    fetch();
    return true;
  }

 private:
  void fetch() {
    SC_ASSERT(writing_ + newest_ + reading_ == 3, "copies {}, {} and {} of three", writing_, newest_,
              reading_);
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
