#pragma once
// The kernels of this project as files: ELF images linked for the local store, built into the library.

#include <cstddef>
#include <span>
#include <string_view>

namespace softcell::spu_kernels {

/// A kernel as an ELF file in the program.
struct ImageFile {
  std::string_view name;
  std::span<const std::byte> elf;          ///< for ls_sim::load_image()
  std::span<const std::byte> checked_elf;  ///< its checked image; empty for one that would not fit
  /// The executable for the SPU, for ls_sim::load_spu_program(); empty for a new kernel that no compiler for the SPU has built.
  std::span<const std::byte> spu_elf;
};

/// All of them, by name.
std::span<const ImageFile> image_files();

/// The file of the kernel of that name, or of its checked image. @throws std::runtime_error  there is none.
std::span<const std::byte> image_file(std::string_view name, bool checked);

/// The executable for the SPU of the kernel of that name. @throws std::runtime_error  there is none.
std::span<const std::byte> spu_image_file(std::string_view name);

}  // namespace softcell::spu_kernels
