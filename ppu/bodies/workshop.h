#pragma once
// What takes long and need not be ready at once, such as pieces of broken bodies, is made on a thread of its own.

#include <chrono>
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
  /// When its thread begins with a task that finds it idle.
  enum class Start {
    kAtOnce,   ///< whoever adds the task wakes it, for 4 to 50 us of his time
    kByClock,  ///< the same, unless tasks come at a regular pace: then it wakes itself a little after one is due. See hurry()
  };
  explicit Workshop(Start start = Start::kAtOnce) : start_(start) {}
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

  /// What was begun is waited for: its thread begins with it now, if it has not yet.
  void hurry();

  /// Destroys what is large on its thread.
  template <class Garbage>
  void dispose(Garbage garbage) {
    const auto held = std::make_shared<Garbage>(std::move(garbage));
    add([held] {});
  }

 private:
  using Clock = std::chrono::steady_clock;

  void add(std::function<void()> task);
  void work();
  void wait_for_task(std::unique_lock<std::mutex>& lock);

  const Start start_;
  std::mutex mutex_;
  std::condition_variable has_changed_;
  std::queue<std::function<void()>> tasks_;
  bool ends_ = false, is_busy_ = false, wakes_itself_ = false;
  Clock::time_point last_{};   // when a task last found it idle
  Clock::duration between_{};  // and how long that was after the one before
  std::thread thread_;
};

}  // namespace softcell::ppu
