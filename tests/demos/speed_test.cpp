// What the design promises about cost, as ratios within one run, with room for a busy machine.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <chrono>
#include <cstddef>
#include <span>
#include <vector>

#include "ppu/bodies/processor_time.h"
#include "ppu/reference/skin_scalar.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "softcell/base/sanitizers.h"
#include "support/median.h"

namespace softcell::demos {
namespace {

#if defined(NDEBUG) && !SC_ADDRESS_SANITIZER && !SC_THREAD_SANITIZER
constexpr bool kOptimised = true;
#else
constexpr bool kOptimised = false;
#endif

/// Skins what the frame shows, as the PPU would have to. @return  milliseconds of processor time
double skin_by_ppu(const Simulation3d& simulation) {
  double sum = 0;
  for (std::size_t b = 0; b < simulation.soft_bodies(); ++b) {
    const ppu::Embedding& embedding = simulation.model(b).embedding();
    std::vector<Eigen::Vector3f> particles;
    for (const Eigen::Vector4f& p : simulation.shown_particles(b)) particles.emplace_back(p.head<3>());
    std::vector<spu::SkinnedVertex> vertices(simulation.shown(b).vertices.size());
    const auto begin = ppu::processor_time();
    for (const ppu::SkinPart& part : embedding.parts)
      ppu::skin_scalar(
          embedding, part, particles, simulation.shown(b).origin,
          std::span(vertices).subspan(std::size_t{4} * part.first_group, std::size_t{4} * part.group_count));
    sum += std::chrono::duration<double, std::milli>(ppu::processor_time() - begin).count();
  }
  return sum;
}

TEST(Speed, ArenaSimulatesSixtyFramesASecondAndHandsSkinningOverForLittleOfItsTime) {
  if (!kOptimised) GTEST_SKIP() << "only an optimised build without sanitizers is measured";
  const Scene scene = load_scene_3d("arena");
  Simulation3d simulation(scene, {});
  std::vector<double> frame_ms, ppu_ms, hand_over_ms, by_ppu_ms;
  for (int i = 0; i < 300; ++i) {
    const FrameTimes times = simulation.step();
    frame_ms.push_back(times.physics_ms + times.ppu_ms);
    ppu_ms.push_back(times.ppu_ms);
    hand_over_ms.push_back(times.skin_ms);
    if (i % 10 == 9) by_ppu_ms.push_back(skin_by_ppu(simulation));
  }
  EXPECT_LT(median(frame_ms), 1000.0 / 60) << "median milliseconds of a frame";
  EXPECT_LT(median(ppu_ms), 5) << "0.6 to 0.8 are measured";
  // What the SPEs take off the PPU: 49,281 vertices.
  EXPECT_LT(median(hand_over_ms), 0.05 * median(by_ppu_ms)) << median(by_ppu_ms);
}

}  // namespace
}  // namespace softcell::demos
