#pragma once
// What takes long and need not be ready at once, such as pieces of broken bodies, is made on a thread of its own.

#include <condition_variable>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <queue>
#include <thread>
#include <type_traits>
#include <utility>

namespace softcell::ppu {

/// Any thread may use it. Its own thread begins with the first task, and takes one after the other.
class Workshop {
 public:
  Workshop() = default;
  /// Waits for the task under way; others are given up.
  ~Workshop();
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  /// @param make  makes something. What it uses outlives this; what it has is destroyed on this thread
  template <class Make>
  std::future<std::invoke_result_t<Make>> begin(Make make) {
    // Not a std::packaged_task: that keeps `make` for as long as somebody has the future.
    using Made = std::promise<std::invoke_result_t<Make>>;
    const auto task = std::make_shared<std::pair<Made, Make>>(Made(), std::move(make));
    std::future<std::invoke_result_t<Make>> made = task->first.get_future();
    add([task] {
      try {
        task->first.set_value(task->second());
      } catch (...) {
        task->first.set_exception(std::current_exception());
      }
    });
    return made;
  }

  /// Destroys what is large on its thread.
  template <class Garbage>
  void dispose(Garbage garbage) {
    const auto held = std::make_shared<Garbage>(std::move(garbage));
    add([held] {});
  }

 private:
  void add(std::function<void()> task);
  void work();

  std::mutex mutex_;
  std::condition_variable has_changed_;
  std::queue<std::function<void()>> tasks_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace softcell::ppu
