#include "softcell/render/image_compare.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace softcell::render {
namespace {

constexpr int kSide = 100;  // 10,000 pixels: the rule lets 20 of them differ

Image grey_picture() {
  Image image(kSide, kSide);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = i % 4 == 3 ? 255 : 100;
  return image;
}

/// The grey picture with the first `count` pixels brighter by `amount` in green.
Image with_brighter_pixels(int count, int amount) {
  Image image = grey_picture();
  for (int i = 0; i < count; ++i) {
    image.pixel(i % kSide, i / kSide)[1] = static_cast<std::uint8_t>(100 + amount);
  }
  return image;
}

TEST(Compare, FindsNoDifferenceBetweenEqualPictures) {
  const ImageDifference difference = compare(grey_picture(), grey_picture());
  EXPECT_EQ(difference.max, 0);
  EXPECT_EQ(difference.over_0, 0u);
  EXPECT_EQ(difference.rmse, 0);
  EXPECT_EQ(difference.pixels, 10000u);
  EXPECT_TRUE(within_golden_rule(difference));
}

TEST(Compare, CountsOnePixelOnceWithItsLargestChannel) {
  Image other = grey_picture();
  other.pixel(7, 93)[0] = 110;
  other.pixel(7, 93)[2] = 80;
  const ImageDifference difference = compare(other, grey_picture());
  EXPECT_EQ(difference.max, 20);
  EXPECT_EQ(difference.over_0, 1u);
  EXPECT_EQ(difference.over_2, 1u);
  EXPECT_EQ(difference.over_8, 1u);
  // sqrt((10^2 + 20^2) / 40000)
  EXPECT_DOUBLE_EQ(difference.rmse, 0.11180339887498949);
}

TEST(Compare, TakesItsThresholdsAsMoreThan) {
  EXPECT_EQ(compare(with_brighter_pixels(5, 2), grey_picture()).over_2, 0u);
  EXPECT_EQ(compare(with_brighter_pixels(5, 3), grey_picture()).over_2, 5u);
  EXPECT_EQ(compare(with_brighter_pixels(5, 8), grey_picture()).over_8, 0u);
  EXPECT_EQ(compare(with_brighter_pixels(5, 9), grey_picture()).over_8, 5u);
}

TEST(Compare, RefusesPicturesOfDifferentSize) {
  const ImageDifference difference = compare(Image(4, 6), Image(6, 4));
  EXPECT_FALSE(difference.same_size);
  EXPECT_FALSE(within_golden_rule(difference));
}

TEST(GoldenRule, ForgivesTheLastBitsOfAFewPixels) {
  EXPECT_TRUE(within_golden_rule(compare(with_brighter_pixels(20, 2), grey_picture())));
}

TEST(GoldenRule, RefusesTooManyPixelsHoweverClose) {
  EXPECT_FALSE(within_golden_rule(compare(with_brighter_pixels(21, 1), grey_picture())));
}

TEST(GoldenRule, RefusesASinglePixelThatIsFurtherOff) {
  EXPECT_FALSE(within_golden_rule(compare(with_brighter_pixels(1, 3), grey_picture())));
}

TEST(DifferenceImage, AmplifiesAndSaturates) {
  const Image image = difference_image(with_brighter_pixels(1, 3), grey_picture(), 32);
  EXPECT_EQ(image.pixel(0, 0)[0], 0);
  EXPECT_EQ(image.pixel(0, 0)[1], 96);
  EXPECT_EQ(image.pixel(0, 0)[3], 255);
  EXPECT_EQ(image.pixel(1, 0)[1], 0);
  EXPECT_EQ(difference_image(with_brighter_pixels(1, 9), grey_picture(), 32).pixel(0, 0)[1], 255);
}

TEST(ImageHash, DependsOnPixelsAndOnShape) {
  Image wide(8, 2);
  Image tall(2, 8);
  EXPECT_NE(image_hash(wide), image_hash(tall));
  Image changed = wide;
  changed.pixel(7, 1)[3] = 1;
  EXPECT_NE(image_hash(wide), image_hash(changed));
  EXPECT_EQ(image_hash(wide), image_hash(Image(8, 2)));
}

}  // namespace
}  // namespace softcell::render
