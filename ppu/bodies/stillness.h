#pragma once

#include <Eigen/Core>
#include <cmath>

#include "softcell/base/assert.h"

namespace softcell::ppu {

/// The root mean square of particles' speeds, weighted by mass.
class MeanSpeed {
 public:
  /// @param velocity  m/s
  template <int kDimension>
  void add(float mass, const Eigen::Matrix<float, kDimension, 1>& velocity) {
    mass_ += double{mass};
    twice_energy_ += double{mass} * double{velocity.squaredNorm()};
  }
  float value() const { return static_cast<float>(std::sqrt(twice_energy_ / mass_)); }  ///< m/s

 private:
  double mass_ = 0, twice_energy_ = 0;
};

/// Measures for how long a soft body has been still. The mean speed is smoothed, because a single particle of a pressed body may jump for a
/// step although the body stays in place. Used by one thread.
class Stillness {
 public:
  /// Call it after each step.
  /// @param mean_speed  m/s: with which particles have really moved. It is SoftBody::mean_speed() unless contacts push them, too
  /// @param speed  m/s: slower bodies are still
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
