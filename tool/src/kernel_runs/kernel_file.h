#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "softcell/ls_sim/image.h"
#include "softcell/spu_kernels/load_kernel.h"

namespace softcell::tool {

/// The bytes by which the stack of a checked image is larger than its kernel declares, because the checks need them.
inline constexpr std::uint32_t kCheckStackBytes = SOFTCELL_CHECKED_STACK_BYTES;

/// kCheckStackBytes for a checked image, 0 for any other image.
inline std::uint32_t stack_for_checks(const ls_sim::KernelImage& image) {
  return image.checked && image.machine == ls_sim::Machine::kHost ? kCheckStackBytes : 0;
}

/// The names of all kernels of this project, sorted.
/// @param checked  only kernels that have a checked image
std::vector<std::string> built_in_kernels(bool checked);

/// A kernel of this project has an executable for the SPU: a new one may have none.
bool is_built_for_spu(const std::string& built_in_kernel);

using spu_kernels::load_kernel;

/// The file that load_kernel_file() reads; none for a kernel of this project.
/// @throws std::runtime_error  one sentence: there is no checked image.
std::optional<std::filesystem::path> find_kernel_file(const std::string& image, bool checked);

/// Loads a kernel by the path of its .spu.elf file, by the path of a program built for the SPU, or by name if it is a kernel of this
/// project.
/// @param checked  load its checked image: NAME.checked.spu.elf beside NAME.spu.elf. A program built for the SPU
///                 needs none.
/// @param machine  refuse an image for another machine.
/// @throws std::runtime_error  one sentence: there is no such file or kernel, no checked image, it is for another machine, or it cannot be
/// loaded.
ls_sim::KernelImage load_kernel_file(const std::string& image, bool checked,
                                     std::optional<ls_sim::Machine> machine = {});

}  // namespace softcell::tool
