#pragma once
// Checks what must hold for every loaded image, whatever its bytes, for the fuzzers of both kinds of images.

#include <cstdlib>
#include <span>

#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim {

inline void require(bool condition) {
  if (!condition) std::abort();
}

inline void require_within_image(const KernelImage& image, std::span<const ImageObject> objects) {
  for (const ImageObject& object : objects) {
    require(object.begin.value >= image.begin && object.begin.value < image.sizes.end);
    require(object.bytes <= image.sizes.end - object.begin.value);
  }
}

/// The image fits a local store, its sections are in order, and its functions and objects are within it.
inline void require_sound(const KernelImage& image) {
  require(image.sizes.end <= dma::kLocalStoreBytes && image.sizes.total() <= dma::kLocalStoreBytes);
  require(image.begin + image.bytes.size() <= image.sizes.end);
  require(image.begin <= image.text_begin && image.text_begin <= image.text_end);
  require(image.text_end <= image.rodata_begin && image.rodata_begin <= image.rodata_end);
  require(image.rodata_end <= image.data_begin && image.data_begin <= image.data_end);
  require(image.data_end <= image.begin + image.bytes.size());
  require_within_image(image, image.objects);
  require_within_image(image, image.functions);
}

}  // namespace softcell::ls_sim
