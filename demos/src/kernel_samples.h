#pragma once
// A representative piece of work for each kernel, for measuring what it needs.

#include <cstdint>
#include <vector>

#include "softcell/ls_sim/image.h"

namespace softcell::demos {

/// Every kernel of the project, loaded, in order of name.
std::vector<ls_sim::KernelImage> load_kernels();

/// The kernel of that name, or its checked flavour. @throws std::runtime_error  there is none.
ls_sim::KernelImage load_kernel(std::string_view name, bool checked = false);

/// Bytes of stack that the kernel used at most on its sample of work.
/// @throws std::runtime_error  the sample failed, or the kernel has none.
std::uint32_t measure_stack(const ls_sim::KernelImage& kernel);

}  // namespace softcell::demos
