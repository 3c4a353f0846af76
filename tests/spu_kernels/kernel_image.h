#pragma once
// The project's kernels by name, for tests.

#include <stdexcept>
#include <string>

#include "softcell/ls_sim/image.h"
#include "softcell/spu_kernels/images.h"

namespace softcell::test {

inline ls_sim::KernelImage kernel_image(const std::string& name, bool checked = false) {
  for (const spu_kernels::ImageFile& file : spu_kernels::image_files())
    if (file.name == name) return ls_sim::load_image(name, checked ? file.checked_elf : file.elf);
  throw std::logic_error("no kernel " + name);
}

}  // namespace softcell::test
