#include "kernel_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string_view>

#include "softcell/spu_kernels/images.h"

namespace softcell::tool {
namespace {

constexpr std::string_view kSuffix = ".spu.elf";
constexpr std::string_view kCheckedSuffix = ".checked.spu.elf";

/// The file that holds the wanted image: one beside this file, or this file itself.
std::filesystem::path wanted_image(const std::filesystem::path& file, bool checked) {
  const std::string text = file.string();
  if (!checked || text.ends_with(kCheckedSuffix) || spu_kernels::holds_checked_image(file)) return file;
  if (!text.ends_with(kSuffix)) {
    throw std::runtime_error(
        "--checked " + text +
        ": takes NAME.checked.spu.elf beside NAME.spu.elf, and this file's name does not "
        "end so");
  }
  std::filesystem::path neighbour =
      text.substr(0, text.size() - kSuffix.size()) + std::string(kCheckedSuffix);
  if (!std::filesystem::exists(neighbour)) {
    throw std::runtime_error(
        "there is no checked image of " + text + ": " + neighbour.string() +
        " does not exist; softcell_add_spu_kernel makes both, and softcell-spu-gcc a file with both");
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

/// A program for the SPU has no checked image, because the interpreter sees each access by itself.
bool is_spu_file(const std::filesystem::path& file) {
  constexpr std::size_t kHeaderBytes = 52;  // of a 32-bit ELF file
  std::array<char, kHeaderBytes> header{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(header.data(), header.size());
  return ls_sim::is_spu_program(
      std::as_bytes(std::span(header)).first(static_cast<std::size_t>(stream.gcount())));
}

ls_sim::KernelImage load_any(const std::string& image, bool checked, std::optional<ls_sim::Machine> machine) {
  if (const auto file = find_kernel_file(image, checked)) {
    const bool is_within = checked && !file->string().ends_with(kCheckedSuffix) && !is_spu_file(*file);
    ls_sim::KernelImage loaded = spu_kernels::load_kernel_file(*file, is_within);
    if (loaded.machine == ls_sim::Machine::kSpu) loaded.checked = checked;
    return loaded;
  }
  if (is_built_in(image)) return load_kernel(image, checked, machine.value_or(ls_sim::Machine::kHost));
  throw std::runtime_error("there is no file " + image + ", and no kernel of softcell has that name (" +
                           built_in_names() + ")");
}

}  // namespace

std::vector<std::string> built_in_kernels(bool checked) {
  std::vector<std::string> names;
  for (const spu_kernels::ImageFile& file : spu_kernels::image_files())
    if (!checked || !file.checked_elf.empty()) names.emplace_back(file.name);
  std::ranges::sort(names);
  return names;
}

bool is_built_for_spu(const std::string& built_in_kernel) {
  return std::ranges::any_of(spu_kernels::image_files(), [&](const spu_kernels::ImageFile& file) {
    return file.name == built_in_kernel && !file.spu_elf.empty();
  });
}

std::optional<std::filesystem::path> find_kernel_file(const std::string& image, bool checked) {
  std::error_code ignored;
  if (!std::filesystem::exists(image, ignored)) return std::nullopt;
  return wanted_image(image, checked && !is_spu_file(image));
}

ls_sim::KernelImage load_kernel_file(const std::string& image, bool checked,
                                     std::optional<ls_sim::Machine> machine) {
  ls_sim::KernelImage loaded = load_any(image, checked, machine);
  if (!machine || *machine == loaded.machine) return loaded;
  const bool is_spu = loaded.machine == ls_sim::Machine::kSpu;
  throw std::runtime_error(
      "--engine " + std::string(is_spu ? "native " : "interpreter ") + image +
      (is_spu ? ": this is a program built for the SPU, which the engine interpreter runs"
              : ": this image is built for the host; the engine interpreter runs programs that a "
                "compiler for the SPU has made (32-bit big-endian ELF files for machine 23)"));
}

}  // namespace softcell::tool
