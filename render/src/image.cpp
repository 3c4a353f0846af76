#include "softcell/render/image.h"

#define XXH_INLINE_ALL  // the header alone, no library to link
#include <xxhash.h>

#include "softcell/base/assert.h"

namespace softcell::render {

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
