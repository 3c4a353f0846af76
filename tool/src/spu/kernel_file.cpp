#include "kernel_file.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "softcell/spu_kernels/images.h"

namespace softcell::tool {
namespace {

constexpr std::string_view kSuffix = ".spu.elf";
constexpr std::string_view kCheckedSuffix = ".checked.spu.elf";

/// The file that holds the flavour asked for.
std::filesystem::path flavour_of(const std::filesystem::path& file, bool checked) {
  const std::string text = file.string();
  if (!checked || text.ends_with(kCheckedSuffix)) return file;
  if (!text.ends_with(kSuffix)) {
    throw std::runtime_error(
        "--checked " + text +
        ": takes NAME.checked.spu.elf beside NAME.spu.elf, and this file's name does not "
        "end so");
  }
  std::filesystem::path neighbour =
      text.substr(0, text.size() - kSuffix.size()) + std::string(kCheckedSuffix);
  if (!std::filesystem::exists(neighbour)) {
    throw std::runtime_error("there is no checked flavour of " + text + ": " + neighbour.string() +
                             " does not exist; softcell_add_spu_kernel makes both");
  }
  return neighbour;
}

bool is_built_in(std::string_view name) {
  const auto files = spu_kernels::image_files();
  return std::any_of(files.begin(), files.end(), [&](const auto& file) { return file.name == name; });
}

std::string built_in_names() {
  std::string names;
  for (const spu_kernels::ImageFile& file : spu_kernels::image_files())
    names += (names.empty() ? "" : ", ") + std::string(file.name);
  return names;
}

}  // namespace

std::vector<std::string> built_in_kernels(bool checked) {
  std::vector<std::string> names;
  for (const spu_kernels::ImageFile& file : spu_kernels::image_files())
    if (!checked || !file.checked_elf.empty()) names.emplace_back(file.name);
  std::ranges::sort(names);
  return names;
}

std::optional<std::filesystem::path> find_kernel_file(const std::string& image, bool checked) {
  std::error_code ignored;
  if (!std::filesystem::exists(image, ignored)) return std::nullopt;
  return flavour_of(image, checked);
}

ls_sim::KernelImage load_kernel_file(const std::string& image, bool checked) {
  if (const auto file = find_kernel_file(image, checked)) return spu_kernels::load_kernel_file(*file);
  if (is_built_in(image)) return load_kernel(image, checked);
  throw std::runtime_error("there is no file " + image + ", and no kernel of softcell has that name (" +
                           built_in_names() + ")");
}

}  // namespace softcell::tool
