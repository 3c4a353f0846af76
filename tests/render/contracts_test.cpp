// What callers of render must keep to: who does not is told by an assertion, with the values.

#include <filesystem>

#include "../support/contract.h"
#include "softcell/render/camera.h"
#include "softcell/render/image.h"
#include "softcell/render/image_compare.h"
#include "softcell/render/overlay.h"
#include "softcell/render/png_io.h"

namespace softcell::render {
namespace {

TEST(RenderContractsDeathTest, ACameraLooksSomewhere) {
  SC_EXPECT_VIOLATES(look_at({1, 2, 3}, {1, 2, 3}, {0, 1, 0}),
                     "camera\\.cpp:[0-9]+: .*look_at.*: SC_ASSERT\\(eye != target\\).*\\(1 2 3\\)\n");
  SC_EXPECT_VIOLATES(look_at({0, 5, 0}, {0, 0, 0}, {0, 1, 0}), "up \\(0 1 0\\) is along the line of sight\n");
}

TEST(RenderContractsDeathTest, TheFarPlaneIsBehindTheNearOne) {
  SC_EXPECT_VIOLATES(perspective(0.4f, 1, 5, 2), "perspective.*: near plane 5, far plane 2\n");
  SC_EXPECT_VIOLATES(orthographic(0, 1, 2), "half_width 0, near plane 1, far plane 2\n");
}

TEST(RenderContractsDeathTest, APixelLiesInItsPicture) {
  const Image image(4, 3);
  SC_EXPECT_VIOLATES(static_cast<void>(image.pixel(4, 2)), "pixel \\(4, 2\\) of 4 by 3\n");
  SC_EXPECT_VIOLATES(Image(-1, 3), "a picture of -1 by 3 pixels\n");
}

TEST(RenderContractsDeathTest, APictureHasTheBytesOfItsPixels) {
  Image image(4, 3);
  image.rgba.pop_back();
  SC_EXPECT_VIOLATES(image_hash(image), "image_hash.*: 47 bytes for 4 by 3 pixels\n");
  SC_EXPECT_VIOLATES(write_png("broken.png", image), "47 bytes for 4 by 3 pixels, to broken\\.png\n");
}

TEST(RenderContractsDeathTest, PicturesThatAreSubtractedHaveOneSize) {
  SC_EXPECT_VIOLATES(difference_image(Image(4, 3), Image(3, 4)), "4 by 3 pixels and 3 by 4\n");
}

TEST(RenderContractsDeathTest, AFontIsThatOfTheCurrentOverlay) {
  const Overlay first, second;
  SC_EXPECT_VIOLATES(static_cast<void>(first.font()),
                     "font.*: the font of the overlay at .*, which is not the current one\n");
}

TEST(RenderContractsDeathTest, AFontHasASize) { SC_EXPECT_VIOLATES(Overlay(0), "a font scaled by 0\n"); }

}  // namespace
}  // namespace softcell::render
