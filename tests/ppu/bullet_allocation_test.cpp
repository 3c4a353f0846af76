// A program of its own: it counts the calls of operator new.

#include <gtest/gtest.h>

#include "soft_body_scenes.h"
#include "support/allocation_counter.h"

namespace softcell::ppu {
namespace {

TEST(BulletSoftBodies, AllocateNothingInASteadyRun) {
  World world;
  world.add_floor();
  world.soft.add(block_model({4, 4, 4}, {.cell_size = 0.2f}), {0, 0.05f, 0});
  world.run(0.5f);
  const std::size_t before = softcell::test::allocations();  // of operator new: Bullet's own go elsewhere
  world.run(0.5f);
  EXPECT_EQ(softcell::test::allocations(), before);
}

}  // namespace
}  // namespace softcell::ppu
