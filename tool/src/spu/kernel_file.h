#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "softcell/ls_sim/image.h"
#include "softcell/spu_kernels/load_kernel.h"

namespace softcell::tool {

/// Every kernel of the project, loaded, in order of name.
std::vector<ls_sim::KernelImage> load_kernels();

using spu_kernels::load_kernel;

/// The file that load_kernel_file() reads; none when the kernel is one of this project's.
/// @throws std::runtime_error  one sentence: there is no such flavour.
std::optional<std::filesystem::path> find_kernel_file(const std::string& image, bool checked);

/// Loads a kernel by the path of its .spu.elf file, or by name when it is one of this project's.
/// @param checked  take its instrumented flavour: NAME.checked.spu.elf beside NAME.spu.elf.
/// @throws std::runtime_error  one sentence: neither, no such flavour, or why it is not loadable.
ls_sim::KernelImage load_kernel_file(const std::string& image, bool checked);

}  // namespace softcell::tool
