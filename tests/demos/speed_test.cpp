// What the design promises about cost, as ratios within one run, with room for a busy machine.

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "ppu/reference/skin_scalar.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "softcell/base/sanitizers.h"
#include "softcell/soft_bodies/shapes.h"
#include "support/median.h"

namespace softcell::demos {
namespace {

#if defined(NDEBUG) && !SC_ADDRESS_SANITIZER && !SC_THREAD_SANITIZER
constexpr bool kOptimised = true;
#else
constexpr bool kOptimised = false;
#endif

TEST(Speed, ArenaSimulatesSixtyFramesASecondAndSkinningIsLittleOfThePpusTime) {
  if (!kOptimised) GTEST_SKIP() << "only an optimised build without sanitizers is measured";
  const Scene scene = load_scene_3d("arena");
  Simulation3d simulation(scene, {});
  std::vector<double> frame_ms;
  double frames = 0, skinning = 0;
  for (int i = 0; i < 300; ++i) {
    const FrameTimes times = simulation.step();
    frame_ms.push_back(times.physics_ms + times.ppu_ms);
    frames += frame_ms.back();
    skinning += times.skin_ms;
  }
  EXPECT_LT(median(frame_ms), 1000.0 / 60) << "median milliseconds of a frame";
  EXPECT_LT(skinning / frames, 0.02);
}

}  // namespace
}  // namespace softcell::demos
