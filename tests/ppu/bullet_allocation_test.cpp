// A program of its own: it counts the calls of operator new.

#include <gtest/gtest.h>

#include "soft_body_scenes.h"
#include "support/allocation_counter.h"

namespace softcell::ppu {
namespace {

class AllocationsOf : public testing::TestWithParam<ContactMethod> {};

TEST_P(AllocationsOf, BodiesOnAFloorAreNoneInASteadyRun) {
  World world(GetParam());
  world.add_floor();
  world.soft.add(block_model({4, 4, 4}, {.cell_size = 0.2f}), {0, 0.05f, 0});
  world.soft.add(block_model({2, 2, 2}, {.cell_size = 0.2f}), {0, 1.1f, 0});
  world.run(0.5f);
  const std::size_t before = softcell::test::allocations();  // of operator new: Bullet's own go elsewhere
  world.run(0.5f);
  EXPECT_EQ(softcell::test::allocations(), before);
}

INSTANTIATE_TEST_SUITE_P(Contacts, AllocationsOf,
                         testing::Values(ContactMethod::kSpheres, ContactMethod::kSurface));

}  // namespace
}  // namespace softcell::ppu
