#include "softcell/ls_sim/source_lines.h"

#include <dwarf.h>
#include <elfutils/libdw.h>
#include <libelf.h>

#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace softcell::ls_sim {
namespace {

constexpr std::string_view kLibraryFolder = "/sdk/library/";

/// Headers that no user of the SDK has written: the SDK's own and the compiler's.
bool is_foreign(std::string_view file) {
  for (const std::string_view folder : std::initializer_list<std::string_view>{
           "/sdk/host/", "/sdk/c/", "/sdk/shared/", kLibraryFolder, "/sdk/check/", "/lib/gcc/", "/lib/clang/",
           "/usr/include/", "/lib/llvm-"}) {
    if (file.find(folder) != std::string_view::npos) return true;
  }
  return false;
}

/// The compilation unit of an instruction. Not by dwarf_addrdie(), which needs a table that Clang leaves out.
bool find_unit(Dwarf* dwarf, Dwarf_Addr address, Dwarf_Die& unit) {
  Dwarf_CU* compilation_unit = nullptr;
  while (dwarf_get_units(dwarf, compilation_unit, &compilation_unit, nullptr, nullptr, &unit, nullptr) == 0) {
    if (dwarf_haspc(&unit, address) > 0) return true;
  }
  return false;
}

/// The scope that holds an instruction and those around it, innermost first. Not lexically, as the source has
/// them, but as the code was inlined.
std::vector<Dwarf_Die> inlining_scopes(Dwarf* dwarf, Dwarf_Die* unit, Dwarf_Addr address) {
  std::vector<Dwarf_Die> scopes;
  Dwarf_Die* lexical = nullptr;
  if (dwarf_getscopes(unit, address, &lexical) > 0) {
    Dwarf_Die innermost, *found = nullptr;
    if (dwarf_offdie(dwarf, dwarf_dieoffset(lexical), &innermost) != nullptr) {
      const int count = dwarf_getscopes_die(&innermost, &found);
      if (count > 0) scopes.assign(found, found + count);
    }
    std::free(found);
  }
  std::free(lexical);
  return scopes;
}

/// Where the code of this inlined function was called.
SourcePlace call_site(Dwarf_Die* unit, Dwarf_Die* inlined) {
  Dwarf_Attribute attribute;
  Dwarf_Word file = 0, line = 0;
  Dwarf_Files* files = nullptr;
  if (dwarf_formudata(dwarf_attr(inlined, DW_AT_call_file, &attribute), &file) != 0 ||
      dwarf_formudata(dwarf_attr(inlined, DW_AT_call_line, &attribute), &line) != 0 ||
      dwarf_getsrcfiles(unit, &files, nullptr) != 0) {
    return {};
  }
  const char* const name = dwarf_filesrc(files, file, nullptr, nullptr);
  return name == nullptr ? SourcePlace{} : SourcePlace{name, static_cast<int>(line)};
}

SourcePlace line_of(Dwarf_Die* unit, Dwarf_Addr address) {
  Dwarf_Line* const row = dwarf_getsrc_die(unit, address);
  const char* const name = row == nullptr ? nullptr : dwarf_linesrc(row, nullptr, nullptr);
  SourcePlace result;
  if (name == nullptr || dwarf_lineno(row, &result.line) != 0) return {};
  result.file = name;
  return result;
}

/// A name relative to the folder in which the compiler ran, as of a header by -I../include, becomes an absolute one.
std::string absolute_name(Dwarf_Die* unit, const std::string& file) {
  Dwarf_Attribute attribute;
  const char* const folder = dwarf_formstring(dwarf_attr(unit, DW_AT_comp_dir, &attribute));
  if (folder == nullptr || file.empty() || file.front() == '/') return file;
  return (std::filesystem::path(folder) / file).lexically_normal().string();
}

std::string to_place(const SourcePlace& source) {
  if (source.file.empty()) return {};
  return source.file.substr(source.file.rfind('/') + 1) + ":" + std::to_string(source.line);
}

}  // namespace

struct SourceLines::Reader {
  explicit Reader(const KernelImage& image) : file(image.elf) {
    if (!file) return;
    elf_version(EV_CURRENT);
    // It is only read, although libelf's signature has no const.
    elf = elf_memory(reinterpret_cast<char*>(const_cast<std::byte*>(file->data())), file->size());
    if (elf != nullptr) dwarf = dwarf_begin_elf(elf, DWARF_C_READ, nullptr);
  }
  ~Reader() {
    dwarf_end(dwarf);
    elf_end(elf);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  SourcePlace find(Dwarf_Addr address) const {
    Dwarf_Die unit;
    if (dwarf == nullptr || !find_unit(dwarf, address, unit)) return {};
    const SourcePlace innermost = line_of(&unit, address);
    SourcePlace source = innermost;
    for (Dwarf_Die& scope : inlining_scopes(dwarf, &unit, address)) {
      if (!is_foreign(source.file)) break;
      if (dwarf_tag(&scope) == DW_TAG_inlined_subroutine) source = call_site(&unit, &scope);
    }
    if (source.file.empty()) source = innermost;
    source.file = absolute_name(&unit, source.file);
    return source;
  }

  std::shared_ptr<const std::vector<std::byte>> file;
  Elf* elf = nullptr;
  Dwarf* dwarf = nullptr;
  // A loop asks for the same place again and again.
  std::unordered_map<std::uint32_t, std::string> known;
  std::unordered_map<std::uint32_t, bool> of_library;
};

SourceLines::SourceLines(const KernelImage& image) : reader_(std::make_unique<Reader>(image)) {}
SourceLines::~SourceLines() = default;

std::string SourceLines::place_of(dma::LocalStoreAddress instruction) const {
  const auto [entry, is_new] = reader_->known.try_emplace(instruction.value);
  if (is_new) entry->second = to_place(reader_->find(instruction.value));
  return entry->second;
}

bool SourceLines::is_in_library(dma::LocalStoreAddress instruction) const {
  const auto [entry, is_new] = reader_->of_library.try_emplace(instruction.value);
  if (is_new) entry->second = reader_->find(instruction.value).file.find(kLibraryFolder) != std::string::npos;
  return entry->second;
}

SourcePlace SourceLines::source_of(dma::LocalStoreAddress instruction) const {
  return reader_->find(instruction.value);
}

}  // namespace softcell::ls_sim
