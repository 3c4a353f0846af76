#include "programs.h"

#include <elf.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "libspe2.h"
#include "object.h"

using softcell::libspe2::fail;
using softcell::libspe2::Machine;
using softcell::libspe2::Objects;
using softcell::libspe2::ProgramHandle;
using softcell::libspe2::shielded;
using softcell::ls_sim::KernelImage;

namespace {

using Bytes = std::vector<std::byte>;

/// A program of a file.
struct OpenedProgram {
  ProgramHandle handle{};
  std::string name;
  Bytes bytes, checked_bytes;
};

// ---- ELF files in memory, whose length only they themselves say

/// A number of an ELF file, in the file's byte order.
std::uint64_t number_at(const std::byte* at, std::size_t bytes, bool big_endian) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i)
    value = value << 8 | std::to_integer<std::uint64_t>(at[big_endian ? i : bytes - 1 - i]);
  return value;
}

/// The end of the last thing that its header or one of its tables mentions.
/// @return  0: it is no ELF file.
std::size_t elf_bytes(const void* image) {
  const auto* const elf = static_cast<const std::byte*>(image);
  if (std::memcmp(elf, ELFMAG, SELFMAG) != 0) return 0;
  const bool wide = elf[EI_CLASS] == std::byte{ELFCLASS64}, big = elf[EI_DATA] == std::byte{ELFDATA2MSB};
  const auto field = [&](std::size_t narrow_at, std::size_t wide_at, std::size_t narrow_bytes,
                         std::size_t wide_bytes) {
    return number_at(elf + (wide ? wide_at : narrow_at), wide ? wide_bytes : narrow_bytes, big);
  };
  const auto header = [&](std::size_t narrow_at, std::size_t wide_at) {
    return field(narrow_at, wide_at, 2, 2);
  };
  const std::uint64_t segments = field(offsetof(Elf32_Ehdr, e_phoff), offsetof(Elf64_Ehdr, e_phoff), 4, 8);
  const std::uint64_t segment_bytes =
      header(offsetof(Elf32_Ehdr, e_phentsize), offsetof(Elf64_Ehdr, e_phentsize));
  const std::uint64_t segment_count = header(offsetof(Elf32_Ehdr, e_phnum), offsetof(Elf64_Ehdr, e_phnum));
  const std::uint64_t sections = field(offsetof(Elf32_Ehdr, e_shoff), offsetof(Elf64_Ehdr, e_shoff), 4, 8);
  const std::uint64_t section_bytes =
      header(offsetof(Elf32_Ehdr, e_shentsize), offsetof(Elf64_Ehdr, e_shentsize));
  const std::uint64_t section_count = header(offsetof(Elf32_Ehdr, e_shnum), offsetof(Elf64_Ehdr, e_shnum));

  std::uint64_t end = wide ? sizeof(Elf64_Ehdr) : sizeof(Elf32_Ehdr);
  const auto number = [&](const std::byte* at, std::size_t narrow_at, std::size_t wide_at) {
    return number_at(at + (wide ? wide_at : narrow_at), wide ? 8 : 4, big);
  };
  for (std::uint64_t i = 0; i < segment_count; ++i) {
    const std::byte* const at = elf + segments + i * segment_bytes;
    end = std::max(end, number(at, offsetof(Elf32_Phdr, p_offset), offsetof(Elf64_Phdr, p_offset)) +
                            number(at, offsetof(Elf32_Phdr, p_filesz), offsetof(Elf64_Phdr, p_filesz)));
  }
  end = std::max(end, segments + segment_count * segment_bytes);
  for (std::uint64_t i = 0; i < section_count; ++i) {
    const std::byte* const at = elf + sections + i * section_bytes;
    const std::size_t type_at = wide ? offsetof(Elf64_Shdr, sh_type) : offsetof(Elf32_Shdr, sh_type);
    if (number_at(at + type_at, 4, big) == SHT_NOBITS) continue;
    end = std::max(end, number(at, offsetof(Elf32_Shdr, sh_offset), offsetof(Elf64_Shdr, sh_offset)) +
                            number(at, offsetof(Elf32_Shdr, sh_size), offsetof(Elf64_Shdr, sh_size)));
  }
  return std::max(end, sections + section_count * section_bytes);
}

// ---- files

/// @return  nothing, with errno set.
std::optional<Bytes> read_file(const char* path) {
  const int file = open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  Bytes bytes;
  std::array<std::byte, 65536> part;
  ssize_t got = 0;
  while ((got = read(file, part.data(), part.size())) > 0)
    bytes.insert(bytes.end(), part.begin(), part.begin() + got);
  const int error = errno;
  close(file);
  errno = error;
  if (got < 0) return std::nullopt;
  return bytes;
}

/// "saxpy" of "kernels/saxpy.spu.elf".
std::string program_name(const std::filesystem::path& file) {
  std::string name = file.filename();
  for (const std::string_view extension : {".spu.elf", ".elf"}) {
    if (name.ends_with(extension) && name.size() > extension.size())
      return name.substr(0, name.size() - extension.size());
  }
  return name;
}

/// The file of the checked image: saxpy.checked.spu.elf beside saxpy.spu.elf.
std::filesystem::path checked_file(const std::filesystem::path& file) {
  const std::string name = file.filename();
  const std::string stem = program_name(file);
  return file.parent_path() / (stem + ".checked" + name.substr(stem.size()));
}

spe_program_handle_t* no_program(int error) {
  errno = error;
  return nullptr;
}

std::span<const std::byte> whole_file_at(const void* elf) {
  return {static_cast<const std::byte*>(elf), elf_bytes(elf)};
}

/// The image of a handle, plain or checked.
std::shared_ptr<const KernelImage> image_of(const spe_program_handle_t& program) {
  const bool extended = program.handle_size >= sizeof(ProgramHandle);
  const auto* const handle = extended ? reinterpret_cast<const ProgramHandle*>(&program) : nullptr;
  const std::string name = extended && handle->name != nullptr ? handle->name : "embedded program";
  return softcell::libspe2::program_in_memory(name, program.elf_image,
                                              extended ? handle->checked_elf_image : nullptr);
}

}  // namespace

namespace softcell::libspe2 {

std::shared_ptr<const KernelImage> program_in_memory(std::string_view name, const void* elf,
                                                     const void* checked_elf) {
  const std::span<const std::byte> file = whole_file_at(elf);
  const auto own_name = ls_sim::image_section(file, ".softcell.name");
  const std::string called(
      own_name.empty() ? name
                       : std::string_view(reinterpret_cast<const char*>(own_name.data()), own_name.size()));
  if (!Machine::get().settings().checked)
    return std::make_shared<const KernelImage>(ls_sim::load_image(called, file));
  const auto checked =
      checked_elf != nullptr ? whole_file_at(checked_elf) : ls_sim::image_section(file, ".softcell.checked");
  if (checked.empty()) {
    throw std::runtime_error("SPE program " + called +
                             " has no checked image, and SOFTCELL_CHECKED asks for it; build it with "
                             "softcell-spu-gcc or softcell_add_spu_kernel");
  }
  return std::make_shared<const KernelImage>(ls_sim::load_image(called, checked));
}

std::shared_ptr<const KernelImage> program_in_file(const std::string& path, std::uint64_t offset) {
  const auto bytes = read_file(path.c_str());
  if (!bytes) return nullptr;
  const std::string name = program_name(path);
  if (offset >= bytes->size())
    throw std::runtime_error(path + " has no SPE program at byte " + std::to_string(offset));
  // Loads it once to check it by the size of the file. Later loads trust the header.
  static_cast<void>(ls_sim::load_image(name, std::span(*bytes).subspan(offset)));
  std::optional<Bytes> checked;
  if (Machine::get().settings().checked && offset == 0) checked = read_file(checked_file(path).c_str());
  if (checked) static_cast<void>(ls_sim::load_image(name, *checked));
  return program_in_memory(name, bytes->data() + offset, checked ? checked->data() : nullptr);
}

}  // namespace softcell::libspe2

spe_program_handle_t* spe_image_open(const char* filename) {
  return shielded<spe_program_handle_t*>(nullptr, [&] {
    if (filename == nullptr) return no_program(EFAULT);
    auto program = std::make_shared<OpenedProgram>();
    auto bytes = read_file(filename);
    if (!bytes) return no_program(errno);
    program->bytes = std::move(*bytes);
    program->name = program_name(filename);
    if (Machine::get().settings().checked) {
      if (auto checked = read_file(checked_file(filename).c_str()))
        program->checked_bytes = std::move(*checked);
    }
    // Loads it once to check it by the size of the file. Later loads trust the header.
    try {
      static_cast<void>(softcell::ls_sim::load_image(program->name, program->bytes));
      if (!program->checked_bytes.empty())
        static_cast<void>(softcell::ls_sim::load_image(program->name, program->checked_bytes));
    } catch (const std::runtime_error& error) {
      Machine::complain(error.what());
      return no_program(ENOEXEC);
    }
    program->handle = {
        .base = {.handle_size = sizeof(ProgramHandle),
                 .elf_image = program->bytes.data(),
                 .toe_shadow = nullptr},
        .checked_elf_image = program->checked_bytes.empty() ? nullptr : program->checked_bytes.data(),
        .name = program->name.c_str()};
    static_assert(offsetof(OpenedProgram, handle) == 0, "the program's pointer is that of its handle");
    return &Objects<OpenedProgram>::all().add(std::move(program))->handle.base;
  });
}

int spe_image_close(spe_program_handle_t* program) {
  return shielded(
      -1, [&] { return Objects<OpenedProgram>::all().remove(program) == nullptr ? fail(EINVAL) : 0; });
}

int spe_program_load(spe_context_ptr_t spe, spe_program_handle_t* program) {
  return softcell::libspe2::with_context(spe, [&](spe_context& context) {
    if (program == nullptr || program->elf_image == nullptr || elf_bytes(program->elf_image) == 0)
      return fail(EINVAL);
    if (context.busy.exchange(true)) return fail(EBUSY);
    int result = 0;
    try {
      auto image = image_of(*program);
      context.spe->load(image);
      const std::lock_guard lock(context.mutex);
      context.image = std::move(image);
      context.goes_on = false;
    } catch (const std::runtime_error& error) {
      Machine::complain(error.what());
      result = fail(EINVAL);
    }
    context.busy = false;
    return result;
  });
}
