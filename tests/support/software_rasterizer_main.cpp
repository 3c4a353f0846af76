// main() of test programs whose pictures are compared: drawn by Mesa's software rasterizer, as everywhere.

#include <gtest/gtest.h>

#include "softcell/render/offscreen_context.h"

int main(int argc, char** argv) {
  softcell::render::pin_software_rasterizer();
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
