#include "softcell/render/image.h"

#define XXH_INLINE_ALL  // the header alone, no library to link
#include <xxhash.h>

#include <array>

#include "softcell/base/assert.h"
#include "softcell/render/frame.h"

namespace softcell::render {
namespace {

constexpr std::uint32_t kWhite = 65535;  // linear light

/// Between the encoding of pixels and linear light.
struct LightTables {
  std::array<std::uint16_t, 256> linear;         // of each encoded value
  std::array<std::uint8_t, kWhite + 1> encoded;  // of each linear one: the nearest
};

const LightTables& light_tables() {
  static const LightTables tables = [] {
    LightTables made{};
    for (std::uint32_t i = 0; i < 256; ++i)
      made.linear[i] = static_cast<std::uint16_t>(srgb(i).z() * static_cast<float>(kWhite) + 0.5f);
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < made.encoded.size(); ++i) {
      while (value < 255 && 2 * i > std::uint32_t{made.linear[value]} + made.linear[value + 1]) ++value;
      made.encoded[i] = static_cast<std::uint8_t>(value);
    }
    return made;
  }();
  return tables;
}

}  // namespace

void make_smaller(const Image& image, int factor, Image& result) {
  SC_ASSERT(image.is_whole() && factor > 0 && image.width % factor == 0 && image.height % factor == 0,
            "{} bytes for {} by {} pixels, to be smaller by {}", image.rgba.size(), image.width, image.height,
            factor);
  if (result.width != image.width / factor || result.height != image.height / factor)
    result = Image(image.width / factor, image.height / factor);
  const LightTables& tables = light_tables();
  const auto count = static_cast<std::uint32_t>(factor * factor);
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) {
      std::array<std::uint32_t, 4> sums{};
      for (int j = 0; j < factor; ++j) {
        const std::uint8_t* pixel = image.pixel(x * factor, y * factor + j);
        for (int i = 0; i < factor; ++i, pixel += 4) {
          for (std::size_t c = 0; c < 3; ++c) sums[c] += tables.linear[pixel[c]];
          sums[3] += pixel[3];
        }
      }
      std::uint8_t* const to = result.pixel(x, y);
      for (std::size_t c = 0; c < 3; ++c) to[c] = tables.encoded[(sums[c] + count / 2) / count];
      to[3] = static_cast<std::uint8_t>((sums[3] + count / 2) / count);
    }
  }
}

Image::Image(int image_width, int image_height) : width(image_width), height(image_height) {
  SC_ASSERT(width >= 0 && height >= 0, "a picture of {} by {} pixels", width, height);
  rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

std::uint64_t image_hash(const Image& image) {
  SC_ASSERT(image.is_whole(), "{} bytes for {} by {} pixels", image.rgba.size(), image.width, image.height);
  const std::uint64_t size =
      static_cast<std::uint64_t>(image.width) << 32 | static_cast<std::uint32_t>(image.height);
  return XXH3_64bits_withSeed(image.rgba.data(), image.rgba.size(), size);
}

}  // namespace softcell::render
