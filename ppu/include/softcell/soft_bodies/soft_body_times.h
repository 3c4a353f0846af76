#pragma once
// The time that soft bodies take in the steps of a world.

#include <chrono>

namespace softcell::ppu {

/// The time that the soft bodies of a BulletSoftBodies or Box2dSoftBodies have taken since its construction, by parts. Processor times are
/// those of the thread that steps the world.
struct SoftBodyTimes {
  /// Processor time to take particles over from the engine, integrate inner ones, test for breaks, and put bodies to sleep.
  std::chrono::nanoseconds gather{0};
  std::chrono::nanoseconds solve{0};     ///< processor time of the solver on this thread
  std::chrono::nanoseconds apply{0};     ///< processor time: velocities to the engine
  std::chrono::nanoseconds contacts{0};  ///< processor time of contacts of surfaces
  /// Elapsed time from when the step needed the solver's result until it had it.
  std::chrono::nanoseconds wait{0};

  /// The processor time of all parts.
  std::chrono::nanoseconds processor() const { return gather + solve + apply + contacts; }
};

}  // namespace softcell::ppu
