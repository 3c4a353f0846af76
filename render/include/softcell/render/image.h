#pragma once
// A picture in memory.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "softcell/base/assert.h"

namespace softcell::render {

/// RGBA8, sRGB-encoded, rows from top to bottom without padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;

  Image() = default;
  /// A transparent black picture. @pre width and height are not negative
  Image(int image_width, int image_height);

  /// The four channels of the pixel in column x and row y, counted from the top left. @pre inside the picture
  const std::uint8_t* pixel(int x, int y) const { return rgba.data() + offset(x, y); }
  /// The same, to be changed.
  std::uint8_t* pixel(int x, int y) { return rgba.data() + offset(x, y); }

  /// Whether `rgba` has exactly four bytes for each pixel: every function that takes a picture needs that.
  bool is_whole() const {
    return width >= 0 && height >= 0 &&
           rgba.size() == 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }

  bool operator==(const Image&) const = default;

 private:
  std::size_t offset(int x, int y) const {
    SC_ASSERT(x >= 0 && x < width && y >= 0 && y < height, "pixel ({}, {}) of {} by {}", x, y, width, height);
    return 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

/// Makes a picture smaller by a whole factor: the mean of squares of factor x factor pixels, in linear light. Any thread.
/// @param result  its width and height are the picture's divided by the factor; overwritten
/// @pre  the picture is whole, and its sides are multiples of the factor, which is above 0
void make_smaller(const Image& image, int factor, Image& result);

/// XXH3 (64 bits) of the pixels, seeded with width and height: equal pictures, equal hashes, on every host.
std::uint64_t image_hash(const Image& image);

}  // namespace softcell::render
