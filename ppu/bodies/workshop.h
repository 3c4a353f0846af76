#pragma once
// Runs slow tasks whose results are not needed at once, such as making pieces of broken bodies, on a thread of its own.

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

/// Any thread may use it. Its own thread starts with the first task and runs one task after the other.
class Workshop {
 public:
  /// How the idle thread learns of a new task.
  enum class Start {
    kAtOnce,  ///< the thread that adds a task wakes it, which takes 4 to 50 us
    kByClock,  ///< the same, but with tasks at a regular pace it wakes itself a little after one is due. See hurry()
  };
  explicit Workshop(Start start = Start::kAtOnce) : start_(start) {}
  /// Waits for the current task; the others are dropped.
  ~Workshop();
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  /// @param make  makes the result. The data that it refers to must outlive this object; its own data is destroyed on this thread
  template <class Make>
  std::future<std::invoke_result_t<Make>> begin(Make make) {
    // Not a std::packaged_task, which keeps `make` for as long as somebody has the future.
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

  /// Tells that somebody waits for a task: the thread begins with it now, if it has not yet.
  void hurry();

  /// Destroys a large object on the workshop's thread.
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
  Clock::time_point last_{};   // when a task last found the thread idle
  Clock::duration between_{};  // the time between that task and the one before
  std::thread thread_;
};

}  // namespace softcell::ppu
