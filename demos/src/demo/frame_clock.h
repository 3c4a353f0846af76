#pragma once

#include <chrono>
#include <thread>

namespace softcell::demos {

/// Frames of 1/60 s in real time. Used by one thread.
class FrameClock {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::nanoseconds kFrame{1'000'000'000 / 60};

  /// Waits until the next frame is due. A late frame is due at once, and the frames after it count from there: lost time is not made up
  /// for, since that would make later frames late as well.
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
