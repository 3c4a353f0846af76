// A steady frame allocates nothing on the PPU side outside Bullet, which has an allocator of its own and does
// not use operator new for what it makes in a step.

#include <gtest/gtest.h>

#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "support/allocation_counter.h"
#include "support/slow_build.h"

namespace softcell::demos {
namespace {

TEST(Allocation, ASteadyFrameAllocatesNothing) {
  if (kSlowBuild)
    GTEST_SKIP() << "too slow with sanitizers; the number of allocations is the same in every build";
  const Scene scene = load_scene_3d("arena");
  Simulation3d simulation(scene, {});
  ASSERT_GT(test::allocations(), 0u) << "allocations are not counted";
  for (int frame = 0; frame < 2400; ++frame)
    simulation.step();  // the floor tilts, and lists grow by doubling while more touches than ever before
  const std::size_t before = test::allocations();
  for (int frame = 0; frame < 120; ++frame) simulation.step();
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace softcell::demos
