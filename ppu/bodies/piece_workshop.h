#pragma once
// Makes pieces of broken bodies on a thread of its own.

#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <queue>
#include <thread>
#include <type_traits>
#include <utility>

namespace softcell::ppu {

/// Used by one thread. Its own thread begins with the first break, and takes one after the other.
class PieceWorkshop {
 public:
  PieceWorkshop() = default;
  /// Waits for the break that is made; others are given up.
  ~PieceWorkshop();
  PieceWorkshop(const PieceWorkshop&) = delete;
  PieceWorkshop& operator=(const PieceWorkshop&) = delete;

  /// @param make  makes the pieces of one break. What it uses outlives this
  template <class Make>
  std::future<std::invoke_result_t<Make>> begin(Make make) {
    const auto task = std::make_shared<std::packaged_task<std::invoke_result_t<Make>()>>(std::move(make));
    std::future<std::invoke_result_t<Make>> pieces = task->get_future();
    add([task] { (*task)(); });
    return pieces;
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
