#include "softcell/spu_kernels/images.h"

#include <array>
#include <stdexcept>
#include <string>

#define SC_DECLARE(kernel)                                                           \
  extern const std::byte softcell_image_##kernel[], softcell_image_##kernel##_end[]; \
  extern const std::byte softcell_image_##kernel##_checked[], softcell_image_##kernel##_checked_end[];

extern "C" {
extern const std::byte softcell_image_job_loop[], softcell_image_job_loop_end[];
SC_DECLARE(match)
SC_DECLARE(match_2d)
SC_DECLARE(match_tiles)
SC_DECLARE(rotations)
SC_DECLARE(skin)
SC_DECLARE(transfers)
}
#undef SC_DECLARE

namespace softcell::spu_kernels {

std::span<const ImageFile> image_files() {
#define SC_FILE(kernel)                                                                        \
  ImageFile {                                                                                  \
    .name = #kernel, .elf = {softcell_image_##kernel, softcell_image_##kernel##_end},          \
    .checked_elf = {softcell_image_##kernel##_checked, softcell_image_##kernel##_checked_end}, \
  }
  static const std::array files{ImageFile{.name = "job_loop",
                                          .elf = {softcell_image_job_loop, softcell_image_job_loop_end},
                                          .checked_elf = {}},
                                SC_FILE(match),
                                SC_FILE(match_2d),
                                SC_FILE(match_tiles),
                                SC_FILE(rotations),
                                SC_FILE(skin),
                                SC_FILE(transfers)};
#undef SC_FILE
  return files;
}

std::span<const std::byte> image_file(std::string_view name, bool checked) {
  for (const ImageFile& file : image_files()) {
    if (file.name != name) continue;
    if (checked && file.checked_elf.empty()) {
      throw std::runtime_error("kernel " + std::string(name) +
                               " has no checked flavour: it would not fit in a local store");
    }
    return checked ? file.checked_elf : file.elf;
  }
  throw std::runtime_error("there is no kernel " + std::string(name));
}

}  // namespace softcell::spu_kernels
