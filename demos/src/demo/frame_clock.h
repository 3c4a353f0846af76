#pragma once

#include <chrono>
#include <thread>

namespace softcell::demos {

/// Frames of 1/60 s in real time. Used by one thread.
class FrameClock {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::nanoseconds kFrame{1'000'000'000 / 60};

  /// Until the next frame is due. A late one is due at once, and those after it count from there: time that
  /// is lost is not made up for, which would make frames later still.
  void wait() {
    next_ += kFrame;
    const Clock::time_point now = Clock::now();
    if (next_ < now) {
      next_ = now;
    } else {
      std::this_thread::sleep_until(next_);
    }
  }

 private:
  Clock::time_point next_ = Clock::now();
};

}  // namespace softcell::demos
