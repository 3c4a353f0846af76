// What a frame in three dimensions is said to have cost.

#include "simulation/simulation_3d.h"

#include <gtest/gtest.h>

#include <chrono>

#include "ppu/bullet/processor_time.h"
#include "scene_file/scene_library.h"

namespace softcell::demos {

/// In the names of tests.
void PrintTo(Skin skin, std::ostream* out) { *out << (skin == Skin::kSpe ? "spe" : "gpu"); }

namespace {

class FrameTimesOf : public testing::TestWithParam<Skin> {};

TEST_P(FrameTimesOf, ThePpuAreTheSumOfItsPartsAndNoMoreThanTheThreadHasUsed) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d simulation(scene, {.skin = GetParam(), .spes = 2});
  for (int frame = 0; frame < 10; ++frame) {
    const auto before = ppu::processor_time();
    const FrameTimes times = simulation.step();
    const std::chrono::duration<double, std::milli> used = ppu::processor_time() - before;
    EXPECT_GT(times.gather_ms, 0) << "frame " << frame;
    EXPECT_GT(times.solve_ms, 0) << "frame " << frame;
    EXPECT_GT(times.apply_ms, 0) << "frame " << frame;
    EXPECT_GT(times.skin_ms, 0) << "frame " << frame;
    EXPECT_GT(times.contacts_ms, 0) << "frame " << frame;
    EXPECT_DOUBLE_EQ(times.ppu_ms,
                     times.gather_ms + times.solve_ms + times.apply_ms + times.contacts_ms + times.skin_ms)
        << "frame " << frame << ": gather " << times.gather_ms << ", solve " << times.solve_ms << ", apply "
        << times.apply_ms << ", contacts " << times.contacts_ms << ", skin " << times.skin_ms;
    EXPECT_LE(times.ppu_ms, used.count()) << "frame " << frame;
  }
}

INSTANTIATE_TEST_SUITE_P(Skins, FrameTimesOf, testing::Values(Skin::kSpe, Skin::kGpu));

}  // namespace
}  // namespace softcell::demos
