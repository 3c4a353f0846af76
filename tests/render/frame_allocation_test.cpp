#include <span>

#include <gtest/gtest.h>

#include "pinned_context.h"
#include "support/allocation_counter.h"
#include "test_scene.h"

namespace softcell::render {
namespace {

TEST(SteadyFrame, AllocatesNothing) {
  Renderer renderer(test::pinned_context(), {.width = 160, .height = 90});
  const test::TestScene scene(renderer, 1);
  const test::SkinnedMesh torus = test::make_torus(32, 16);
  SkinnedDraw item;
  item.mesh = renderer.add_mesh(torus.indices);
  item.origin = {0, 2, 0};
  FrameDescription frame = scene.frame();
  frame.skinned = std::span(&item, 1);
  const auto draw = [&] {
    renderer.update_mesh(item.mesh, torus.bytes());
    renderer.render(frame);
    renderer.pixels();
  };
  for (int warm_up = 0; warm_up < 3; ++warm_up) draw();

  const std::size_t before = softcell::test::allocations();
  ASSERT_GT(before, 0) << "the counter counts";
  for (int i = 0; i < 5; ++i) draw();
  EXPECT_EQ(softcell::test::allocations() - before, 0u);
}

}  // namespace
}  // namespace softcell::render
