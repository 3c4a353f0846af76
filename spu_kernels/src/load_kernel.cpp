#include "softcell/spu_kernels/load_kernel.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "softcell/base/read_file.h"
#include "softcell/spu_kernels/images.h"

namespace softcell::spu_kernels {
namespace {

/// With all that a debugger wants to know, far more than an image of 256 KB needs.
constexpr std::uint64_t kMostImageBytes = std::uint64_t{256} << 20;
constexpr std::string_view kCheckedSection = ".softcell.checked";

bool begins_as_elf(std::span<const std::byte> bytes) {
  constexpr std::array<std::byte, 4> kMagic{std::byte{0x7F}, std::byte{'E'}, std::byte{'L'}, std::byte{'F'}};
  return bytes.size() >= kMagic.size() && std::ranges::equal(kMagic, bytes.first(kMagic.size()));
}

}  // namespace

ls_sim::KernelImage load_kernel(std::string_view name, bool checked, ls_sim::Machine machine) {
  if (machine == ls_sim::Machine::kSpu) {
    ls_sim::KernelImage image = ls_sim::load_spu_program(name, spu_image_file(name));
    image.checked = checked;
    return image;
  }
  return ls_sim::load_image(name, image_file(name, checked));
}

bool holds_checked_image(const std::filesystem::path& file) {
  const auto bytes = base::read_file(file, kMostImageBytes);
  return begins_as_elf(bytes) && !ls_sim::image_section(bytes, kCheckedSection).empty();
}

ls_sim::KernelImage load_kernel_file(const std::filesystem::path& file, bool checked) {
  std::string name = file.filename().string();
  for (const std::string_view suffix : {".checked.spu.elf", ".spu.elf", ".elf"}) {
    if (name.size() <= suffix.size() || !name.ends_with(suffix)) continue;
    name.resize(name.size() - suffix.size());
    break;
  }
  const auto bytes = base::read_file(file, kMostImageBytes);
  if (!begins_as_elf(bytes))
    throw std::runtime_error(
        file.string() +
        " is not an ELF file; a kernel is the file NAME.spu.elf that softcell_add_spu_kernel "
        "makes, or an executable that a compiler for the SPU has made");
  try {
    if (checked) {
      const auto checked_image = ls_sim::image_section(bytes, kCheckedSection);
      if (checked_image.empty())
        throw std::runtime_error("it holds no checked image; softcell-spu-gcc makes files that do");
      return ls_sim::load_image(name, checked_image);
    }
    return ls_sim::is_spu_program(bytes) ? ls_sim::load_spu_program(name, bytes)
                                         : ls_sim::load_image(name, bytes);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

}  // namespace softcell::spu_kernels
