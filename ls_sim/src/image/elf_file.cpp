#include "elf_file.h"

#include <algorithm>
#include <stdexcept>

namespace softcell::ls_sim {
namespace {

Elf64_Ehdr widened(const Elf32_Ehdr& h) {
  Elf64_Ehdr wide{};
  std::memcpy(wide.e_ident, h.e_ident, sizeof wide.e_ident);
  wide.e_type = h.e_type;
  wide.e_machine = h.e_machine;
  wide.e_version = h.e_version;
  wide.e_entry = h.e_entry;
  wide.e_phoff = h.e_phoff;
  wide.e_shoff = h.e_shoff;
  wide.e_flags = h.e_flags;
  wide.e_ehsize = h.e_ehsize;
  wide.e_phentsize = h.e_phentsize;
  wide.e_phnum = h.e_phnum;
  wide.e_shentsize = h.e_shentsize;
  wide.e_shnum = h.e_shnum;
  wide.e_shstrndx = h.e_shstrndx;
  return wide;
}

Elf64_Phdr widened(const Elf32_Phdr& s) {
  return {.p_type = s.p_type,
          .p_flags = s.p_flags,
          .p_offset = s.p_offset,
          .p_vaddr = s.p_vaddr,
          .p_paddr = s.p_paddr,
          .p_filesz = s.p_filesz,
          .p_memsz = s.p_memsz,
          .p_align = s.p_align};
}

Elf64_Shdr widened(const Elf32_Shdr& s) {
  return {.sh_name = s.sh_name,
          .sh_type = s.sh_type,
          .sh_flags = s.sh_flags,
          .sh_addr = s.sh_addr,
          .sh_offset = s.sh_offset,
          .sh_size = s.sh_size,
          .sh_link = s.sh_link,
          .sh_info = s.sh_info,
          .sh_addralign = s.sh_addralign,
          .sh_entsize = s.sh_entsize};
}

Elf64_Sym widened(const Elf32_Sym& s) {
  return {.st_name = s.st_name,
          .st_info = s.st_info,
          .st_other = s.st_other,
          .st_shndx = s.st_shndx,
          .st_value = s.st_value,
          .st_size = s.st_size};
}

Elf64_Rela widened(const Elf32_Rela& r) {
  const std::uint64_t symbol = ELF32_R_SYM(r.r_info), type = ELF32_R_TYPE(r.r_info);
  return {.r_offset = r.r_offset, .r_info = ELF64_R_INFO(symbol, type), .r_addend = r.r_addend};
}

}  // namespace

ElfFile::ElfFile(std::string_view name, std::span<const std::byte> bytes) : name_(name), bytes_(bytes) {
  read_header();
  read_sections();
}

void ElfFile::refuse(const std::string& what) const {
  throw std::runtime_error("kernel image " + std::string(name_) + ": " + what);
}

std::span<const std::byte> ElfFile::slice(std::uint64_t offset, std::uint64_t size, const char* what) const {
  if (offset > bytes_.size() || size > bytes_.size() - offset) {
    refuse(std::string("truncated: ") + what + " lies past the end of the file (" +
           std::to_string(bytes_.size()) + " bytes)");
  }
  return bytes_.subspan(offset, size);
}

/// In brackets, what machine has that number.
static std::string describe_machine(unsigned machine) {
  switch (machine) {
    case EM_SPU:
      return " (a real SPU)";
    case EM_PPC:
    case EM_PPC64:
      return " (a PowerPC, as the console's PPU)";
    case EM_386:
      return " (a 32-bit x86)";
    case EM_AARCH64:
      return " (a 64-bit ARM)";
    case EM_SPU << 8:
      return " (that of a real SPU with its bytes swapped: the file says little-endian and is not)";
    default:
      return "";
  }
}

void ElfFile::read_header() {
  const auto start = bytes_.first(std::min<std::size_t>(bytes_.size(), SELFMAG));
  if (!start.empty() && std::memcmp(start.data(), ELFMAG, start.size()) != 0) refuse("not an ELF file");
  header_ = widened(table<Elf32_Ehdr>(0, 1, "the ELF header").front());
  if (header_.e_ident[EI_CLASS] != ELFCLASS32 || header_.e_ident[EI_DATA] != ELFDATA2LSB ||
      header_.e_machine != EM_X86_64) {
    // The fields after e_ident stand where they stand in either class, but in the file's byte order.
    const bool big_endian = header_.e_ident[EI_DATA] == ELFDATA2MSB;
    const unsigned machine =
        big_endian ? (header_.e_machine >> 8 | (header_.e_machine & 0xFFu) << 8) : header_.e_machine;
    refuse(
        "built for ELF machine " + std::to_string(machine) + describe_machine(machine) +
        (machine == EM_X86_64 ? " with 64-bit pointers" : "") +
        "; the native engine runs x86-64 images with 32-bit pointers, which softcell_add_spu_kernel makes");
  }
  if (header_.e_type != ET_EXEC && header_.e_type != ET_DYN)
    refuse("it is not a linked program; link it with softcell_add_spu_kernel");
  if (header_.e_phentsize != sizeof(Elf32_Phdr) || header_.e_shentsize != sizeof(Elf32_Shdr))
    refuse("its header tables have entries of an unknown size");
}

std::vector<Elf64_Phdr> ElfFile::loadable_segments() const {
  std::vector<Elf64_Phdr> segments;
  for (const auto& segment :
       table<Elf32_Phdr>(header_.e_phoff, header_.e_phnum, "the program header table")) {
    if (segment.p_type == PT_LOAD) segments.push_back(widened(segment));
  }
  return segments;
}

void ElfFile::read_sections() {
  const auto headers = table<Elf32_Shdr>(header_.e_shoff, header_.e_shnum, "the section header table");
  if (header_.e_shstrndx >= headers.size()) refuse("it has no section names");
  const Elf32_Shdr& names = headers[header_.e_shstrndx];
  const auto strings = slice(names.sh_offset, names.sh_size, "the table of section names");
  for (const Elf32_Shdr& section : headers)
    sections_.push_back({text_at(strings, section.sh_name), widened(section)});
}

ElfFile::Section ElfFile::find(std::string_view name) const {
  const auto found =
      std::find_if(sections_.begin(), sections_.end(), [&](const Section& s) { return s.name == name; });
  return found == sections_.end() ? Section{} : *found;
}

std::string_view ElfFile::text_at(std::span<const std::byte> strings, std::uint64_t offset) const {
  if (offset > strings.size()) refuse("a name lies outside its table of names");
  const auto rest = strings.subspan(offset);
  const auto end = std::find(rest.begin(), rest.end(), std::byte{0});
  if (end == rest.end() && !rest.empty()) refuse("a name has no end");
  return {reinterpret_cast<const char*>(rest.data()), static_cast<std::size_t>(end - rest.begin())};
}

std::vector<ElfFile::Symbol> ElfFile::symbols() const {
  const Section table_section = find(".symtab");
  const Elf64_Shdr& where = table_section.header;
  if (where.sh_size == 0) return {};
  if (where.sh_link >= sections_.size()) refuse("its symbols have no names");
  const Elf64_Shdr& names = sections_[where.sh_link].header;
  const auto strings = slice(names.sh_offset, names.sh_size, "the table of symbol names");
  std::vector<Symbol> symbols;
  for (const Elf32_Sym& symbol :
       table<Elf32_Sym>(where.sh_offset, where.sh_size / sizeof(Elf32_Sym), "the symbol table")) {
    symbols.push_back({text_at(strings, symbol.st_name), widened(symbol)});
  }
  return symbols;
}

std::vector<Elf64_Rela> ElfFile::relocations(const Section& section) const {
  const std::uint64_t count = section.header.sh_size / sizeof(Elf32_Rela);
  std::vector<Elf64_Rela> wide;
  for (const auto& record : table<Elf32_Rela>(section.header.sh_offset, count, "a table of relocations"))
    wide.push_back(widened(record));
  return wide;
}

}  // namespace softcell::ls_sim
