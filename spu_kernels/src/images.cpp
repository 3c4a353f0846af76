#include "softcell/spu_kernels/images.h"

#include <array>

extern "C" {
extern const std::byte softcell_image_match[];
extern const std::byte softcell_image_match_end[];
extern const std::byte softcell_image_skin[];
extern const std::byte softcell_image_skin_end[];
extern const std::byte softcell_image_transfers[];
extern const std::byte softcell_image_transfers_end[];
}

namespace softcell::spu_kernels {

std::span<const ImageFile> image_files() {
  static const std::array<ImageFile, 3> files{{
      {"match", {softcell_image_match, softcell_image_match_end}},
      {"skin", {softcell_image_skin, softcell_image_skin_end}},
      {"transfers", {softcell_image_transfers, softcell_image_transfers_end}},
  }};
  return files;
}

}  // namespace softcell::spu_kernels
