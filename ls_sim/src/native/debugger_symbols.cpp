#include "debugger_symbols.h"

#include <elf.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <string>

#include "image/elf_file.h"
#include "softcell/base/assert.h"

// Names, types and values are gdb's: it looks for these two symbols in the program.
extern "C" {

enum JitAction : std::uint32_t { kJitNoAction = 0, kJitRegister = 1, kJitUnregister = 2 };

struct JitCodeEntry {
  JitCodeEntry* next;
  JitCodeEntry* previous;
  const std::byte* symbol_file;
  std::uint64_t symbol_file_bytes;
};

struct JitDescriptor {
  std::uint32_t version;
  std::uint32_t action;
  JitCodeEntry* relevant;
  JitCodeEntry* first;
};

// Hidden: another just-in-time compiler in the process, such as a software renderer's, has its own.
__attribute__((visibility("hidden"), used))
JitDescriptor __jit_debug_descriptor = {1, kJitNoAction, nullptr, nullptr};

// gdb stops here and reads the descriptor.
__attribute__((visibility("hidden"), used, noinline)) void __jit_debug_register_code() {
  asm volatile("" ::: "memory");
}

}  // extern "C"

namespace softcell::ls_sim::native {
namespace {

std::mutex& list_mutex() {
  static std::mutex mutex;
  return mutex;
}

void notify_debugger(JitAction action, JitCodeEntry& entry) {
  __jit_debug_descriptor.action = action;
  __jit_debug_descriptor.relevant = &entry;
  __jit_debug_register_code();
}

/// Adds `amount` to a field of the file.
template <class Field>
void add(std::vector<std::byte>& file, std::uint64_t offset, Field amount) {
  Field value;
  if (offset > file.size() || file.size() - offset < sizeof value) return;
  std::memcpy(&value, file.data() + offset, sizeof value);
  value += amount;
  std::memcpy(file.data() + offset, &value, sizeof value);
}

bool is_loaded(const Elf64_Shdr& section) { return (section.sh_flags & SHF_ALLOC) != 0; }

/// The segments; gdb holds sections against them.
void move_segments(const ElfFile& elf, std::vector<std::byte>& file, std::uint32_t base) {
  const Elf64_Ehdr& header = elf.header();
  for (std::uint64_t i = 0; i < header.e_phnum; ++i) {
    const std::uint64_t at = header.e_phoff + i * sizeof(Elf32_Phdr);
    add(file, at + offsetof(Elf32_Phdr, p_vaddr), base);
    add(file, at + offsetof(Elf32_Phdr, p_paddr), base);
  }
}

/// The sections that are copied into the local store, and the symbols in them.
void move_sections_and_symbols(const ElfFile& elf, std::vector<std::byte>& file, std::uint32_t base) {
  const auto& sections = elf.sections();
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Elf64_Shdr& section = sections[i].header;
    if (is_loaded(section) && section.sh_addr != 0) {
      add(file, elf.header().e_shoff + i * sizeof(Elf32_Shdr) + offsetof(Elf32_Shdr, sh_addr), base);
    }
    if (section.sh_type != SHT_SYMTAB) continue;
    const auto symbols =
        elf.table<Elf32_Sym>(section.sh_offset, section.sh_size / sizeof(Elf32_Sym), "the symbol table");
    for (std::size_t j = 0; j < symbols.size(); ++j) {
      const std::size_t home = symbols[j].st_shndx;
      if (home < sections.size() && is_loaded(sections[home].header)) {
        add(file, section.sh_offset + j * sizeof(Elf32_Sym) + offsetof(Elf32_Sym, st_value), base);
      }
    }
  }
}

/// The addresses in the debug information. All else that was relocated there is an offset within a section
/// that is not loaded. Both are relocated alike; the symbol tells them apart.
bool move_debug_information(const ElfFile& elf, std::vector<std::byte>& file, std::uint32_t base) {
  bool found = false;
  const auto symbols = elf.symbols();
  const auto is_address = [&](std::uint64_t symbol) {
    if (symbol >= symbols.size()) return false;
    const std::size_t home = symbols[symbol].record.st_shndx;
    return home < elf.sections().size() && is_loaded(elf.sections()[home].header);
  };
  for (const ElfFile::Section& table : elf.sections()) {
    if (table.header.sh_type != SHT_RELA || !table.name.starts_with(".rela.debug_")) continue;
    const Elf64_Shdr target = elf.find(table.name.substr(std::strlen(".rela"))).header;
    for (const auto& relocation : elf.relocations(table)) {
      if (ELF64_R_TYPE(relocation.r_info) != R_X86_64_32 || relocation.r_offset >= target.sh_size ||
          !is_address(ELF64_R_SYM(relocation.r_info))) {
        continue;
      }
      add(file, target.sh_offset + relocation.r_offset, base);
      found = true;
    }
  }
  return found;
}

}  // namespace

bool debugger_wanted() {
  if (std::getenv("SOFTCELL_GDB") != nullptr) return true;
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("TracerPid:")) return line.find_first_not_of("0 \t", 10) != std::string::npos;
  }
  return false;
}

std::vector<std::byte> relocate_debug_file(const KernelImage& image, std::uint32_t base) {
  if (!image.elf) return {};
  const ElfFile elf(image.name, *image.elf);
  std::vector<std::byte> file = *image.elf;
  move_segments(elf, file, base);
  move_sections_and_symbols(elf, file, base);
  if (!move_debug_information(elf, file, base)) return {};
  return file;
}

struct DebuggerSymbols::Entry {
  std::vector<std::byte> file;
  JitCodeEntry jit{};
};

DebuggerSymbols::DebuggerSymbols(const KernelImage& image, const std::byte* base) {
  std::vector<std::byte> file;
  try {
    // A local store lies below 4 GB.
    file = relocate_debug_file(image, static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(base)));
  } catch (const std::runtime_error&) {
    return;  // a file that cannot be read shows nothing; the kernel runs without
  }
  if (file.empty()) return;
  entry_ = std::make_unique<Entry>();
  entry_->file = std::move(file);
  entry_->jit.symbol_file = entry_->file.data();
  entry_->jit.symbol_file_bytes = entry_->file.size();

  const std::scoped_lock lock(list_mutex());
  entry_->jit.next = __jit_debug_descriptor.first;
  if (entry_->jit.next != nullptr) entry_->jit.next->previous = &entry_->jit;
  __jit_debug_descriptor.first = &entry_->jit;
  notify_debugger(kJitRegister, entry_->jit);
}

DebuggerSymbols::~DebuggerSymbols() {
  if (!entry_) return;
  const std::scoped_lock lock(list_mutex());
  JitCodeEntry& jit = entry_->jit;
  SC_ASSERT((jit.previous == nullptr ? __jit_debug_descriptor.first : jit.previous->next) == &jit,
            "the file of {} bytes is not where the debugger's list has it", jit.symbol_file_bytes);
  (jit.previous == nullptr ? __jit_debug_descriptor.first : jit.previous->next) = jit.next;
  if (jit.next != nullptr) jit.next->previous = jit.previous;
  notify_debugger(kJitUnregister, jit);
}

}  // namespace softcell::ls_sim::native
