#pragma once
// The tables of an ELF file, read so that no bytes of it can lead outside it.

#include <elf.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace softcell::ls_sim {

/// A little-endian x86 file of class 32: 64-bit code with 32-bit pointers (x32). Its records are shown as those
/// of class 64, so that no sum of addresses, offsets and sizes wraps. The bytes and the name must outlive it.
/// Every error is a std::runtime_error whose message begins with the image's name.
class ElfFile {
 public:
  struct Section {
    std::string_view name;
    Elf64_Shdr header{};
    std::uint64_t end() const { return header.sh_addr + header.sh_size; }
  };

  ElfFile(std::string_view name, std::span<const std::byte> bytes);

  [[noreturn]] void refuse(const std::string& what) const;

  const Elf64_Ehdr& header() const { return header_; }
  std::vector<Elf64_Phdr> loadable_segments() const;

  const std::vector<Section>& sections() const { return sections_; }
  /// The section of that name; an empty one when there is none.
  Section find(std::string_view name) const;

  /// Bytes of the file.
  std::span<const std::byte> slice(std::uint64_t offset, std::uint64_t size, const char* what) const;

  /// All records of a table in the file.
  template <typename Record>
  std::vector<Record> table(std::uint64_t offset, std::uint64_t count, const char* what) const {
    // A count beyond the file would wrap when multiplied.
    const std::uint64_t size = count > bytes_.size() ? count : count * sizeof(Record);
    const auto bytes = slice(offset, size, what);
    std::vector<Record> records(bytes.size() / sizeof(Record));
    if (!records.empty()) std::memcpy(records.data(), bytes.data(), records.size() * sizeof(Record));
    return records;
  }

  struct Symbol {
    std::string_view name;
    Elf64_Sym record{};
  };
  /// The symbol table; empty when the file has none.
  std::vector<Symbol> symbols() const;

  /// The records of a section of type SHT_RELA.
  std::vector<Elf64_Rela> relocations(const Section& section) const;

 private:
  void read_header();
  void read_sections();
  /// The text at an offset of a table of strings, up to its zero.
  std::string_view text_at(std::span<const std::byte> strings, std::uint64_t offset) const;

  std::string_view name_;
  std::span<const std::byte> bytes_;
  Elf64_Ehdr header_{};
  std::vector<Section> sections_;
};

}  // namespace softcell::ls_sim
