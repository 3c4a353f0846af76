#include "ppu/bodies/workshop.h"

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
  SC_ASSERT(task != nullptr, "a task behind {} others does nothing", tasks_.size());
  {
    const std::lock_guard lock(mutex_);
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
    tasks_.push(std::move(task));
  }
  has_changed_.notify_one();
}

void Workshop::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    has_changed_.wait(lock, [this] { return ends_ || !tasks_.empty(); });
    if (ends_) return;
    std::function<void()> task = std::move(tasks_.front());
    tasks_.pop();
    lock.unlock();
    task();
    task = nullptr;  // what it held goes on this thread
    lock.lock();
  }
}

}  // namespace softcell::ppu
