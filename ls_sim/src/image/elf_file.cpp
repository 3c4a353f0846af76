#include "elf_file.h"

#include <algorithm>
#include <stdexcept>

namespace softcell::ls_sim {

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

void ElfFile::read_header() {
  const auto start = bytes_.first(std::min<std::size_t>(bytes_.size(), SELFMAG));
  if (!start.empty() && std::memcmp(start.data(), ELFMAG, start.size()) != 0) refuse("not an ELF file");
  header_ = table<Elf64_Ehdr>(0, 1, "the ELF header").front();
  if (header_.e_ident[EI_CLASS] != ELFCLASS64 || header_.e_ident[EI_DATA] != ELFDATA2LSB ||
      header_.e_machine != EM_X86_64) {
    // The fields after e_ident stand where they stand in either class, but in the file's byte order.
    const bool big_endian = header_.e_ident[EI_DATA] == ELFDATA2MSB;
    const unsigned machine =
        big_endian ? (header_.e_machine >> 8 | (header_.e_machine & 0xFFu) << 8) : header_.e_machine;
    refuse("built for ELF machine " + std::to_string(machine) + (machine == EM_SPU ? " (a real SPU)" : "") +
           "; the native engine runs 64-bit x86 images made by softcell_add_spu_kernel");
  }
  if (header_.e_type != ET_EXEC && header_.e_type != ET_DYN)
    refuse("it is not a linked program; link it with softcell_add_spu_kernel");
  if (header_.e_phentsize != sizeof(Elf64_Phdr) || header_.e_shentsize != sizeof(Elf64_Shdr))
    refuse("its header tables have entries of an unknown size");
}

std::vector<Elf64_Phdr> ElfFile::loadable_segments() const {
  auto segments = table<Elf64_Phdr>(header_.e_phoff, header_.e_phnum, "the program header table");
  std::erase_if(segments, [](const Elf64_Phdr& segment) { return segment.p_type != PT_LOAD; });
  return segments;
}

void ElfFile::read_sections() {
  const auto headers = table<Elf64_Shdr>(header_.e_shoff, header_.e_shnum, "the section header table");
  if (header_.e_shstrndx >= headers.size()) refuse("it has no section names");
  const Elf64_Shdr& names = headers[header_.e_shstrndx];
  const auto strings = slice(names.sh_offset, names.sh_size, "the table of section names");
  for (const Elf64_Shdr& section : headers) {
    const std::string_view name = text_at(strings, section.sh_name);
    if (section.sh_addr > UINT32_MAX || section.sh_size > UINT32_MAX)
      refuse("its section " + std::string(name) + " has an address or size of more than 32 bits");
    sections_.push_back({name, section});
  }
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
  for (const Elf64_Sym& symbol :
       table<Elf64_Sym>(where.sh_offset, where.sh_size / sizeof(Elf64_Sym), "the symbol table")) {
    symbols.push_back({text_at(strings, symbol.st_name), symbol});
  }
  return symbols;
}

}  // namespace softcell::ls_sim
