#include "softcell/render/image.h"

#define XXH_INLINE_ALL  // the header alone, no library to link
#include <xxhash.h>

#include <cassert>

namespace softcell::render {

Image::Image(int image_width, int image_height) : width(image_width), height(image_height) {
  assert(width >= 0 && height >= 0);
  rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

std::uint64_t image_hash(const Image& image) {
  const std::uint64_t size =
      static_cast<std::uint64_t>(image.width) << 32 | static_cast<std::uint32_t>(image.height);
  return XXH3_64bits_withSeed(image.rgba.data(), image.rgba.size(), size);
}

}  // namespace softcell::render
