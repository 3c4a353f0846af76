#pragma once
// A scene's frames without pictures, for benchmarks of whole frames.

#include <chrono>
#include <cmath>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::tool {

/// A scene, simulated as a demo simulates it, skinning included.
/// @tparam Simulation  Simulation2d or Simulation3d, matching the scene's dimension
template <typename Scene, typename Simulation>
class SceneFrames {
 public:
  /// @param frames_before  frames that the constructor simulates, so that bodies lie where they come to rest
  SceneFrames(Scene scene, int frames_before) : scene_(std::move(scene)), simulation_(scene_, {}) {
    SC_ASSERT(frames_before >= 0, "{} frames before those of scene {}", frames_before, scene_.name);
    for (int i = 0; i < frames_before; ++i) step();
  }

  void step() { ppu_milliseconds_ += simulation_.step().ppu_ms; }

  /// Processor time of softcell on the PPU, in all frames.
  std::chrono::nanoseconds ppu_time() const {
    return std::chrono::nanoseconds(std::llround(1e6 * ppu_milliseconds_));
  }

  const Scene& scene() const { return scene_; }
  const Simulation& simulation() const { return simulation_; }

 private:
  Scene scene_;
  Simulation simulation_;
  double ppu_milliseconds_ = 0;
};

}  // namespace softcell::tool
