#pragma once
// Kernels ready to run: softcell's own by name, anybody's from a file. Images that a program carries in itself
// (softcell_embed_spu_images) are read by ls_sim::load_image().

#include <filesystem>
#include <string_view>

#include "softcell/ls_sim/image.h"

namespace softcell::spu_kernels {

/// One of softcell's own kernels, as image_files() names them. Any thread.
/// @param checked  its checked image, which reports each load and store
/// @param machine  kSpu: as the compiler for the SPU has made it, for the interpreter. Any of those can be checked.
/// @throws std::runtime_error  there is no such kernel, or it has no checked image.
ls_sim::KernelImage load_kernel(std::string_view name, bool checked = false,
                                ls_sim::Machine machine = ls_sim::Machine::kHost);

/// A kernel from a file that softcell_add_spu_kernel made: NAME.spu.elf, or NAME.checked.spu.elf for its
/// checked image; or from an executable of a compiler for the SPU, NAME.elf, which the interpreter runs. The
/// image's name is NAME. Any thread.
/// @param checked  the checked image that softcell-spu-gcc has put into the file.
/// @throws std::runtime_error  one sentence that names the file: it cannot be read, it is larger than 256 MB,
///         it is no such image, or it holds no checked image.
ls_sim::KernelImage load_kernel_file(const std::filesystem::path& file, bool checked = false);

/// Whether load_kernel_file() finds a checked image in the file itself. Any thread.
/// @throws std::runtime_error  the file cannot be read, or is larger than 256 MB
bool holds_checked_image(const std::filesystem::path& file);

}  // namespace softcell::spu_kernels
