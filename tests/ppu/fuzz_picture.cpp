// libFuzzer target: any bytes give a whole picture of at most a million pixels or a std::runtime_error.

#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "ppu/mesh_import/picture.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  constexpr std::size_t kMostPixels = std::size_t{1} << 20;
  try {
    const auto picture =
        softcell::ppu::decode_picture({reinterpret_cast<const char*>(data), size}, kMostPixels);
    const std::size_t pixels = picture->rgba.size() / 4;
    const bool whole =
        static_cast<std::size_t>(picture->width) * static_cast<std::size_t>(picture->height) == pixels &&
        4 * pixels == picture->rgba.size() && pixels > 0 && pixels <= kMostPixels;
    if (!whole) std::abort();
  } catch (const std::runtime_error&) {
    // refused, as it may be
  }
  return 0;
}
