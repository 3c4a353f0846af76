#include "softcell/spu_kernels/images.h"

#include <array>
#include <stdexcept>
#include <string>

#define SC_DECLARE(kernel)                                                                     \
  extern const std::byte softcell_image_##kernel[], softcell_image_##kernel##_end[];           \
  extern const std::byte softcell_image_##kernel##_spu[], softcell_image_##kernel##_spu_end[]; \
  extern const std::byte softcell_image_##kernel##_checked[], softcell_image_##kernel##_checked_end[];

extern "C" {
extern const std::byte softcell_image_job_loop[], softcell_image_job_loop_end[];
extern const std::byte softcell_image_job_loop_spu[], softcell_image_job_loop_spu_end[];
SC_DECLARE(attach)
SC_DECLARE(contact_find)
SC_DECLARE(contact_solve)
SC_DECLARE(match)
SC_DECLARE(match_2d)
SC_DECLARE(match_tiles)
SC_DECLARE(rotations)
SC_DECLARE(skin)
SC_DECLARE(strain)
SC_DECLARE(transfers)
}
#undef SC_DECLARE

namespace softcell::spu_kernels {

std::span<const ImageFile> image_files() {
#define SC_FILE(kernel)                                                                        \
  ImageFile {                                                                                  \
    .name = #kernel, .elf = {softcell_image_##kernel, softcell_image_##kernel##_end},          \
    .checked_elf = {softcell_image_##kernel##_checked, softcell_image_##kernel##_checked_end}, \
    .spu_elf = {softcell_image_##kernel##_spu, softcell_image_##kernel##_spu_end},             \
  }
  static const std::array files{
      ImageFile{.name = "job_loop",
                .elf = {softcell_image_job_loop, softcell_image_job_loop_end},
                .checked_elf = {},
                .spu_elf = {softcell_image_job_loop_spu, softcell_image_job_loop_spu_end}},
      SC_FILE(attach),
      SC_FILE(contact_find),
      SC_FILE(contact_solve),
      SC_FILE(match),
      SC_FILE(match_2d),
      SC_FILE(match_tiles),
      SC_FILE(rotations),
      SC_FILE(skin),
      SC_FILE(strain),
      SC_FILE(transfers)};
#undef SC_FILE
  return files;
}

namespace {

const ImageFile& files_of(std::string_view name) {
  for (const ImageFile& file : image_files())
    if (file.name == name) return file;
  std::string names;
  for (const ImageFile& file : image_files()) names += (names.empty() ? "" : ", ") + std::string(file.name);
  throw std::runtime_error("softcell has no kernel " + std::string(name) + "; there are: " + names);
}

}  // namespace

std::span<const std::byte> image_file(std::string_view name, bool checked) {
  const ImageFile& file = files_of(name);
  if (checked && file.checked_elf.empty()) {
    throw std::runtime_error("kernel " + std::string(name) +
                             " has no checked image: it would not fit in a local store");
  }
  return checked ? file.checked_elf : file.elf;
}

std::span<const std::byte> spu_image_file(std::string_view name) {
  const ImageFile& file = files_of(name);
  if (file.spu_elf.empty())
    throw std::runtime_error(
        "kernel " + std::string(name) +
        " has no executable for the SPU: softcell was built without SOFTCELL_SPU_CXX, and "
        "spu_kernels/spu_elf has none");
  return file.spu_elf;
}

}  // namespace softcell::spu_kernels
