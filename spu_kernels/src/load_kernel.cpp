#include "softcell/spu_kernels/load_kernel.h"

#include <cstdint>
#include <string>

#include "softcell/base/read_file.h"
#include "softcell/spu_kernels/images.h"

namespace softcell::spu_kernels {
namespace {

/// With all that a debugger wants to know, far more than an image of 256 KB needs.
constexpr std::uint64_t kMostImageBytes = std::uint64_t{256} << 20;

}  // namespace

ls_sim::KernelImage load_kernel(std::string_view name, bool checked, ls_sim::Machine machine) {
  if (machine == ls_sim::Machine::kSpu) {
    ls_sim::KernelImage image = ls_sim::load_spu_program(name, spu_image_file(name));
    image.checked = checked;
    return image;
  }
  return ls_sim::load_image(name, image_file(name, checked));
}

ls_sim::KernelImage load_kernel_file(const std::filesystem::path& file) {
  std::string name = file.filename().string();
  for (const std::string_view suffix : {".checked.spu.elf", ".spu.elf", ".elf"}) {
    if (name.size() <= suffix.size() || !name.ends_with(suffix)) continue;
    name.resize(name.size() - suffix.size());
    break;
  }
  const auto bytes = base::read_file(file, kMostImageBytes);
  return ls_sim::is_spu_program(bytes) ? ls_sim::load_spu_program(name, bytes)
                                       : ls_sim::load_image(name, bytes);
}

}  // namespace softcell::spu_kernels
