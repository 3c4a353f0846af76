#pragma once

#include "softcell/base/assert.h"

namespace softcell::ppu {

/// Measures for how long a soft body has been still. The mean speed is smoothed, because a single particle of a pressed body may jump for a
/// step although the body stays in place. Used by one thread.
class Stillness {
 public:
  /// Call it after each step. @param mean_speed  SoftBody::mean_speed(), m/s @param speed  m/s: slower bodies are still
  void count(float step, float mean_speed, float speed) {
    SC_ASSERT(step > 0 && speed >= 0, "a body slower than {} m/s is still for {} s", speed, step);
    constexpr float kSmoothing = 0.25f;  // seconds
    const float share = step < kSmoothing ? step / kSmoothing : 1;
    square_ += share * (mean_speed * mean_speed - square_);
    moves_ = !(square_ < speed * speed);
    seconds_ = moves_ ? 0 : seconds_ + step;
  }
  /// Call it when the body is woken: its time starts at 0, and it counts as moving only once it has begun to move.
  void begin() { seconds_ = square_ = 0, moves_ = false; }

  float seconds() const { return seconds_; }
  bool moves() const { return moves_; }  ///< whether it was too fast in the last counted step

 private:
  float seconds_ = 0;
  float square_ = 0;  // of the smoothed speed
  bool moves_ = true;
};

}  // namespace softcell::ppu
