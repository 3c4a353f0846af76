#include "ppu/bodies/workshop.h"

#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {

Workshop::~Workshop() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  has_changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Workshop::add(std::function<void()> task) {
  SC_ASSERT(task != nullptr, "an empty task is added behind {} others", tasks_.size());
  bool wake = false;
  {
    const std::lock_guard lock(mutex_);
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
    if (tasks_.empty() && !is_busy_) {
      const auto now = Clock::now();
      between_ = now - std::exchange(last_, now);
    }
    tasks_.push(std::move(task));
    wake = !wakes_itself_;
  }
  if (wake) has_changed_.notify_one();
}

void Workshop::hurry() {
  {
    const std::lock_guard lock(mutex_);
    if (tasks_.empty()) return;
  }
  has_changed_.notify_one();
}

/// Returns with the lock, when there is a task or the workshop ends.
//
//     tasks    |  between_  |  between_  |        between_ may vary by an eighth; a later task has to wake the thread
//     looks                  | | | |      | | | |
//
void Workshop::wait_for_task(std::unique_lock<std::mutex>& lock) {
  // If tasks come more often than every kShortest, somebody may wait for one before the thread looks. This happens when a game's step is
  // not drawn.
  constexpr auto kShortest = std::chrono::milliseconds(4), kLongest = std::chrono::milliseconds(100);
  constexpr int kLooks = 4;
  const auto has_task = [this] { return ends_ || !tasks_.empty(); };
  if (start_ == Start::kByClock && between_ >= kShortest && between_ <= kLongest) {
    wakes_itself_ = true;
    for (int look = 1; look <= kLooks && !has_task(); ++look)
      has_changed_.wait_until(lock, last_ + between_ + look * between_ / (8 * kLooks), has_task);
    wakes_itself_ = false;
  }
  has_changed_.wait(lock, has_task);
}

void Workshop::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    is_busy_ = false;
    wait_for_task(lock);
    if (ends_) return;
    is_busy_ = true;
    std::function<void()> task = std::move(tasks_.front());
    tasks_.pop();
    lock.unlock();
    task();
    task = nullptr;  // its data is destroyed on this thread
    lock.lock();
  }
}

}  // namespace softcell::ppu
