#include <gtest/gtest.h>

#include "pinned_context.h"
#include "support/golden.h"
#include "test_scene.h"

namespace softcell::render {
namespace {

TEST(GoldenScene, LooksAsItDidWhenSomebodyLookedAtIt) {
  Renderer renderer(test::pinned_context(), {.width = 320, .height = 180});
  const test::TestScene scene(renderer, 1);
  renderer.render(scene.frame());
  EXPECT_TRUE(softcell::test::compare_with_golden(renderer.pixels(), "small_scene"));
}

}  // namespace
}  // namespace softcell::render
