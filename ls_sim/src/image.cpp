#include "softcell/ls_sim/image.h"

#include <elf.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {
namespace {

constexpr std::uint32_t kDeclarationMagic = 0x314B4353;  // "SCK1", written by ls.ld

/// The section that ls.ld writes for the loader.
struct Declaration {
  std::uint32_t magic, stack_bytes, budget_bytes, end;
};

/// Reads structures out of the file, refusing what lies outside it.
class ElfReader {
 public:
  ElfReader(std::string_view name, std::span<const std::byte> file) : name_(name), file_(file) {}

  [[noreturn]] void refuse(const std::string& what) const {
    throw std::runtime_error("kernel image " + std::string(name_) + ": " + what);
  }

  std::span<const std::byte> slice(std::uint64_t offset, std::uint64_t size, const char* what) const {
    if (offset > file_.size() || size > file_.size() - offset) {
      refuse(std::string("truncated: ") + what + " lies past the end of the file (" +
             std::to_string(file_.size()) + " bytes)");
    }
    return file_.subspan(offset, size);
  }

  template <typename T>
  T read(std::uint64_t offset, const char* what) const {
    T value;
    std::memcpy(&value, slice(offset, sizeof value, what).data(), sizeof value);
    return value;
  }

 private:
  std::string_view name_;
  std::span<const std::byte> file_;
};

Elf64_Ehdr read_header(const ElfReader& elf) {
  const auto header = elf.read<Elf64_Ehdr>(0, "the ELF header");
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) elf.refuse("not an ELF file");
  if (header.e_ident[EI_CLASS] != ELFCLASS64 || header.e_ident[EI_DATA] != ELFDATA2LSB ||
      header.e_machine != EM_X86_64) {
    elf.refuse("built for ELF machine " + std::to_string(header.e_machine) +
               "; the native engine runs 64-bit x86 images made by softcell_add_spu_kernel");
  }
  if (header.e_phentsize != sizeof(Elf64_Phdr) || header.e_shentsize != sizeof(Elf64_Shdr)) {
    elf.refuse("its header tables have entries of an unknown size");
  }
  return header;
}

/// The one loadable segment that ls.ld makes, checked against the local store.
Elf64_Phdr read_segment(const ElfReader& elf, const Elf64_Ehdr& header) {
  Elf64_Phdr segment{};
  int count = 0;
  for (std::uint64_t i = 0; i < header.e_phnum; ++i) {
    const auto candidate =
        elf.read<Elf64_Phdr>(header.e_phoff + i * sizeof(Elf64_Phdr), "the program header table");
    if (candidate.p_type != PT_LOAD) continue;
    segment = candidate;
    ++count;
  }
  if (count != 1)
    elf.refuse("it has " + std::to_string(count) + " loadable segments; ls.ld makes exactly one");
  if (segment.p_filesz > segment.p_memsz)
    elf.refuse("its segment holds more bytes in the file than in memory");
  if (segment.p_vaddr != kEnvironmentBytes)
    elf.refuse("its segment does not begin at local-store address 0x80");
  if (segment.p_memsz > dma::kLocalStoreBytes - segment.p_vaddr) {
    elf.refuse("it takes " + std::to_string(segment.p_memsz) +
               " bytes and passes the 256 KB of a local store");
  }
  return segment;
}

class SectionTable {
 public:
  SectionTable(const ElfReader& elf, const Elf64_Ehdr& header) : elf_(elf), header_(header) {
    if (header.e_shstrndx >= header.e_shnum) elf.refuse("it has no section names");
    names_ = section(header.e_shstrndx);
  }

  Elf64_Shdr section(std::uint64_t index) const {
    return elf_.read<Elf64_Shdr>(header_.e_shoff + index * sizeof(Elf64_Shdr), "the section header table");
  }

  bool is_named(const Elf64_Shdr& section, std::string_view name) const {
    const auto names = elf_.slice(names_.sh_offset, names_.sh_size, "the section names");
    if (section.sh_name > names.size() || names.size() - section.sh_name <= name.size()) return false;
    return std::memcmp(names.data() + section.sh_name, name.data(), name.size()) == 0 &&
           names[section.sh_name + name.size()] == std::byte{0};
  }

  Elf64_Shdr find(std::string_view name) const {
    for (std::uint64_t i = 0; i < header_.e_shnum; ++i) {
      if (const Elf64_Shdr candidate = section(i); is_named(candidate, name)) return candidate;
    }
    return {};
  }

 private:
  const ElfReader& elf_;
  const Elf64_Ehdr& header_;
  Elf64_Shdr names_{};
};

}  // namespace

KernelImage load_image(std::string_view name, std::span<const std::byte> file) {
  const ElfReader elf(name, file);
  const Elf64_Ehdr header = read_header(elf);
  const Elf64_Phdr segment = read_segment(elf, header);
  const SectionTable sections(elf, header);

  const Elf64_Shdr declared = sections.find(".softcell.kernel");
  if (declared.sh_size != sizeof(Declaration)) {
    elf.refuse("it has no .softcell.kernel section; link it with softcell_add_spu_kernel");
  }
  const auto declaration = elf.read<Declaration>(declared.sh_offset, "the .softcell.kernel section");
  if (declaration.magic != kDeclarationMagic)
    elf.refuse("its .softcell.kernel section is of another version");
  if (sections.find(".rela.dyn").sh_size != 0) {
    elf.refuse("a relocation is left: an absolute pointer is stored in its static data");
  }

  const Elf64_Shdr text = sections.find(".text"), data = sections.find(".data");
  KernelImage image;
  image.name = name;
  image.sizes.text = static_cast<std::uint32_t>(text.sh_size);
  image.sizes.rodata = static_cast<std::uint32_t>(sections.find(".rodata").sh_size);
  image.sizes.data = static_cast<std::uint32_t>(data.sh_size);
  image.sizes.bss = static_cast<std::uint32_t>(sections.find(".bss").sh_size);
  image.sizes.stack = declaration.stack_bytes;
  image.sizes.budget = declaration.budget_bytes;
  image.sizes.end = declaration.end;

  const std::uint64_t end = segment.p_vaddr + segment.p_memsz;
  if (declaration.end < end || declaration.end - end >= dma::kLineBytes)
    elf.refuse("its sections do not end where _end says");
  if (declaration.stack_bytes == 0 || declaration.stack_bytes % dma::kQuadwordBytes != 0 ||
      declaration.stack_bytes > dma::kLocalStoreBytes - declaration.end) {
    elf.refuse("its declared stack of " + std::to_string(declaration.stack_bytes) +
               " bytes is not a positive multiple of 16 that fits above the image in 256 KB");
  }
  if (header.e_entry < text.sh_addr || header.e_entry - text.sh_addr >= text.sh_size) {
    elf.refuse("its entry lies outside its text");
  }
  const std::uint64_t file_end = segment.p_vaddr + segment.p_filesz;
  if (data.sh_size != 0 &&
      (data.sh_addr < segment.p_vaddr || data.sh_addr > file_end || data.sh_size > file_end - data.sh_addr)) {
    elf.refuse("its data lie outside its segment");
  }
  image.entry = static_cast<std::uint32_t>(header.e_entry);
  image.data_begin = static_cast<std::uint32_t>(data.sh_size != 0 ? data.sh_addr : file_end);
  image.data_end = static_cast<std::uint32_t>(image.data_begin + data.sh_size);
  const auto bytes = elf.slice(segment.p_offset, segment.p_filesz, "its segment");
  image.bytes.assign(bytes.begin(), bytes.end());
  image.elf = std::make_shared<const std::vector<std::byte>>(file.begin(), file.end());
  return image;
}

}  // namespace softcell::ls_sim
