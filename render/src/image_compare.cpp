#include "softcell/render/image_compare.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "softcell/base/assert.h"

namespace softcell::render {

ImageDifference compare(const Image& actual, const Image& expected) {
  ImageDifference result;
  result.same_size = actual.width == expected.width && actual.height == expected.height;
  if (!result.same_size) return result;

  SC_ASSERT(actual.is_whole() && expected.is_whole(), "{} and {} bytes for {} by {} pixels",
            actual.rgba.size(), expected.rgba.size(), actual.width, actual.height);
  result.pixels = actual.rgba.size() / 4;
  std::uint64_t squares = 0;
  for (std::size_t pixel = 0; pixel < result.pixels; ++pixel) {
    int largest = 0;
    for (std::size_t i = 4 * pixel; i < 4 * pixel + 4; ++i) {
      const int distance = std::abs(actual.rgba[i] - expected.rgba[i]);
      largest = std::max(largest, distance);
      squares += static_cast<std::uint64_t>(distance * distance);
    }
    result.max = std::max(result.max, largest);
    result.over_0 += largest > 0;
    result.over_2 += largest > 2;
    result.over_8 += largest > 8;
  }
  if (result.pixels != 0) {
    result.rmse = std::sqrt(static_cast<double>(squares) / static_cast<double>(4 * result.pixels));
  }
  return result;
}

bool within_golden_rule(const ImageDifference& difference) {
  return difference.same_size && difference.max <= kGoldenMaxDifference &&
         static_cast<double>(difference.over_0) <=
             kGoldenMaxDifferingShare * static_cast<double>(difference.pixels);
}

std::string describe(const ImageDifference& difference) {
  if (!difference.same_size) return "the pictures have different sizes";
  char text[200];
  std::snprintf(
      text, sizeof text,
      "largest difference %d, %zu of %zu pixels differ (%zu by more than 2, %zu by more than 8), RMSE %.4f",
      difference.max, difference.over_0, difference.pixels, difference.over_2, difference.over_8,
      difference.rmse);
  return text;
}

Image difference_image(const Image& actual, const Image& expected, int gain) {
  SC_ASSERT(actual.width == expected.width && actual.height == expected.height,
            "{} by {} pixels and {} by {}", actual.width, actual.height, expected.width, expected.height);
  SC_ASSERT(gain > 0, "a gain of {}", gain);
  SC_ASSERT(actual.is_whole() && expected.is_whole(), "{} and {} bytes for {} by {} pixels",
            actual.rgba.size(), expected.rgba.size(), actual.width, actual.height);
  Image result(actual.width, actual.height);
  for (std::size_t i = 0; i < result.rgba.size(); ++i) {
    const int distance = std::abs(actual.rgba[i] - expected.rgba[i]);
    result.rgba[i] =
        i % 4 == 3 ? std::uint8_t{255} : static_cast<std::uint8_t>(std::min(distance * gain, 255));
  }
  return result;
}

}  // namespace softcell::render
