// Executables for the SPU: 32-bit big-endian ELF files.

#include <elf.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "function_names.h"
#include "softcell/base/assert.h"
#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim {
namespace {

constexpr std::uint32_t kOverlayFlag = 0x08000000;  // PF_OVERLAY [GNU binutils] documented

/// The file, read so that no bytes of it can lead outside it.
class SpuElf {
 public:
  struct Segment {
    std::uint32_t offset, address, file_bytes, memory_bytes, flags;
    std::uint32_t end() const { return address + memory_bytes; }
    std::uint32_t file_end() const { return address + file_bytes; }
  };
  struct Section {
    std::uint32_t name, type, flags, address, offset, bytes, link;
  };

  SpuElf(std::string_view name, std::span<const std::byte> bytes) : name_(name), bytes_(bytes) {
    const auto start = bytes_.first(std::min<std::size_t>(bytes_.size(), SELFMAG));
    if (!start.empty() && std::memcmp(start.data(), ELFMAG, start.size()) != 0) refuse("not an ELF file");
    slice(0, sizeof(Elf32_Ehdr), "the ELF header");
    if (!is_spu_program(bytes_)) refuse("not a 32-bit big-endian ELF file for machine 23, the SPU");
    if (half(offsetof(Elf32_Ehdr, e_type)) != ET_EXEC)
      refuse("not a linked executable: its ELF type is " +
             std::to_string(half(offsetof(Elf32_Ehdr, e_type))));
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw std::runtime_error("SPU program " + std::string(name_) + ": " + what);
  }

  std::span<const std::byte> slice(std::uint64_t offset, std::uint64_t size, const char* what) const {
    if (offset > bytes_.size() || size > bytes_.size() - offset) {
      refuse(std::string("truncated: ") + what + " lies past the end of the file (" +
             std::to_string(bytes_.size()) + " bytes)");
    }
    return bytes_.subspan(offset, size);
  }

  std::uint32_t entry() const { return word(offsetof(Elf32_Ehdr, e_entry)); }

  std::vector<Segment> segments() const {
    std::vector<Segment> segments;
    for_each_record(offsetof(Elf32_Ehdr, e_phoff), offsetof(Elf32_Ehdr, e_phentsize),
                    offsetof(Elf32_Ehdr, e_phnum), sizeof(Elf32_Phdr), "the program header table",
                    [&](std::uint64_t at) {
                      if (word(at + offsetof(Elf32_Phdr, p_type)) != PT_LOAD) return;
                      segments.push_back({.offset = word(at + offsetof(Elf32_Phdr, p_offset)),
                                          .address = word(at + offsetof(Elf32_Phdr, p_vaddr)),
                                          .file_bytes = word(at + offsetof(Elf32_Phdr, p_filesz)),
                                          .memory_bytes = word(at + offsetof(Elf32_Phdr, p_memsz)),
                                          .flags = word(at + offsetof(Elf32_Phdr, p_flags))});
                    });
    return segments;
  }

  std::vector<Section> sections() const {
    std::vector<Section> sections;
    for_each_record(offsetof(Elf32_Ehdr, e_shoff), offsetof(Elf32_Ehdr, e_shentsize),
                    offsetof(Elf32_Ehdr, e_shnum), sizeof(Elf32_Shdr), "the section header table",
                    [&](std::uint64_t at) {
                      sections.push_back({.name = word(at + offsetof(Elf32_Shdr, sh_name)),
                                          .type = word(at + offsetof(Elf32_Shdr, sh_type)),
                                          .flags = word(at + offsetof(Elf32_Shdr, sh_flags)),
                                          .address = word(at + offsetof(Elf32_Shdr, sh_addr)),
                                          .offset = word(at + offsetof(Elf32_Shdr, sh_offset)),
                                          .bytes = word(at + offsetof(Elf32_Shdr, sh_size)),
                                          .link = word(at + offsetof(Elf32_Shdr, sh_link))});
                    });
    return sections;
  }

  /// The section of that name, or none.
  std::optional<Section> find(const std::vector<Section>& sections, std::string_view name) const {
    const std::uint32_t names = half(offsetof(Elf32_Ehdr, e_shstrndx));
    if (names >= sections.size()) return std::nullopt;
    const auto strings = slice(sections[names].offset, sections[names].bytes, "the table of section names");
    for (const Section& section : sections)
      if (text_at(strings, section.name) == name) return section;
    return std::nullopt;
  }

  /// A word of a section that find() has found.
  std::uint32_t word_of(const Section& section, std::uint32_t index) const {
    return word(std::uint64_t{section.offset} + index * sizeof(std::uint32_t));
  }

  /// Calls `each(name, address, bytes, type)` for each symbol that has a name and a size.
  template <class Each>
  void for_each_symbol(const std::vector<Section>& sections, Each&& each) const {
    const auto table = std::ranges::find(sections, std::uint32_t{SHT_SYMTAB}, &Section::type);
    if (table == sections.end()) return;
    if (table->link >= sections.size()) refuse("its symbols have no names");
    const Section& names = sections[table->link];
    const auto strings = slice(names.offset, names.bytes, "the table of symbol names");
    slice(table->offset, table->bytes, "the symbol table");
    for (std::uint32_t i = 0; i < table->bytes / sizeof(Elf32_Sym); ++i) {
      const std::uint64_t at = std::uint64_t{table->offset} + i * sizeof(Elf32_Sym);
      const std::string_view name = text_at(strings, word(at + offsetof(Elf32_Sym, st_name)));
      const std::uint32_t size = word(at + offsetof(Elf32_Sym, st_size));
      const auto info = static_cast<unsigned char>(bytes_[at + offsetof(Elf32_Sym, st_info)]);
      if (name.empty()) continue;
      each(name, word(at + offsetof(Elf32_Sym, st_value)), size, ELF32_ST_TYPE(info));
    }
  }

 private:
  std::uint32_t number(std::uint64_t offset, unsigned bytes) const {
    SC_ASSERT(bytes <= sizeof(std::uint32_t), "a number of {} bytes at {}", bytes, offset);
    std::uint32_t value = 0;
    for (const std::byte each : slice(offset, bytes, "a number"))
      value = value << 8 | static_cast<std::uint32_t>(each);
    return value;
  }
  std::uint32_t half(std::uint64_t offset) const { return number(offset, 2); }
  std::uint32_t word(std::uint64_t offset) const { return number(offset, 4); }

  /// Calls `each` with the place of each record of one of the header tables.
  template <class Each>
  void for_each_record(std::size_t table, std::size_t size, std::size_t count, std::size_t expected,
                       const char* what, Each&& each) const {
    const std::uint32_t records = half(count), begin = word(table);
    if (records == 0) return;
    if (half(size) != expected) refuse(std::string(what) + " has entries of an unknown size");
    slice(begin, std::uint64_t{records} * expected, what);
    for (std::uint32_t i = 0; i < records; ++i) each(std::uint64_t{begin} + i * expected);
  }

  std::string_view text_at(std::span<const std::byte> strings, std::uint32_t offset) const {
    if (offset > strings.size()) refuse("a name lies outside its table of names");
    const auto rest = strings.subspan(offset);
    const auto end = std::ranges::find(rest, std::byte{0});
    if (end == rest.end() && !rest.empty()) refuse("a name has no end");
    return {reinterpret_cast<const char*>(rest.data()), static_cast<std::size_t>(end - rest.begin())};
  }

  std::string_view name_;
  std::span<const std::byte> bytes_;
};

/// The segments that are loaded, in order of address, after a check that the local store has room for them.
std::vector<SpuElf::Segment> loaded_segments(const SpuElf& elf) {
  std::vector<SpuElf::Segment> segments = elf.segments();
  if (std::ranges::any_of(segments, [](const auto& s) { return (s.flags & kOverlayFlag) != 0; }))
    elf.refuse("it has overlays, which softcell does not load");
  std::erase_if(segments, [](const auto& s) { return s.memory_bytes == 0; });
  if (segments.empty()) elf.refuse("it has no loadable segment");
  for (const SpuElf::Segment& segment : segments) {
    if (segment.file_bytes > segment.memory_bytes)
      elf.refuse("a segment holds more bytes in the file than in memory");
    if (segment.address >= dma::kLocalStoreBytes ||
        segment.memory_bytes > dma::kLocalStoreBytes - segment.address)
      elf.refuse("its segment at " + std::to_string(segment.address) + " of " +
                 std::to_string(segment.memory_bytes) + " bytes passes the 256 KB of a local store");
    elf.slice(segment.offset, segment.file_bytes, "a segment");
  }
  std::ranges::stable_sort(segments, {}, &SpuElf::Segment::address);
  for (std::size_t i = 1; i < segments.size(); ++i) {
    if (segments[i].address < segments[i - 1].end()) {
      elf.refuse("its segments overlap at address " + std::to_string(segments[i].address) +
                 ": softcell does not load overlays");
    }
  }
  return segments;
}

void copy_bytes(const SpuElf& elf, const std::vector<SpuElf::Segment>& segments, KernelImage& image) {
  std::uint32_t file_end = segments.front().address;
  for (const auto& segment : segments) {
    if (segment.file_bytes != 0) file_end = segment.file_end();
  }
  if (file_end == segments.front().address) elf.refuse("its segments hold no bytes in the file");
  image.bytes.resize(file_end - image.begin);
  for (const auto& segment : segments) {
    if (segment.file_bytes == 0) continue;
    SC_ASSERT(segment.address >= image.begin && segment.file_end() <= file_end,
              "a segment of {} from {} to {} lies outside {} to {}", image.name, segment.address,
              segment.file_end(), image.begin, file_end);
    std::ranges::copy(elf.slice(segment.offset, segment.file_bytes, "a segment"),
                      image.bytes.begin() + (segment.address - image.begin));
  }
}

/// Where instructions, constants and variables lie: by sections, or without them by segments.
void find_parts(const std::vector<SpuElf::Segment>& segments, const std::vector<SpuElf::Section>& sections,
                KernelImage& image) {
  const std::uint32_t file_end = image.begin + static_cast<std::uint32_t>(image.bytes.size());
  std::uint32_t code_end = image.begin, data_begin = file_end;
  image.text_begin = file_end;
  image.text_end = image.begin;
  const auto add_text = [&](std::uint32_t begin, std::uint32_t end) {
    image.text_begin = std::min(image.text_begin, begin);
    image.text_end = std::max(image.text_end, end);
  };
  for (const auto& section : sections) {
    const bool fits = section.address >= image.begin && section.address < file_end &&
                      section.bytes <= file_end - section.address;
    if ((section.flags & SHF_EXECINSTR) != 0 && section.bytes != 0 && fits)
      add_text(section.address, section.address + section.bytes);
  }
  const bool has_sections = image.text_begin < image.text_end;
  for (const auto& segment : segments) {
    if (segment.file_bytes == 0) continue;
    if ((segment.flags & PF_X) != 0 && !has_sections) add_text(segment.address, segment.file_end());
    if ((segment.flags & PF_W) == 0) {
      code_end = std::max(code_end, segment.file_end());
    } else {
      data_begin = std::min(data_begin, segment.address);
    }
  }
  if (image.text_begin >= image.text_end) image.text_begin = image.text_end = image.begin;
  image.rodata_begin = image.text_end;
  image.rodata_end = std::max(image.text_end, std::min(code_end, data_begin));
  image.data_begin = std::max(image.rodata_end, data_begin);
  image.data_end = std::max(image.data_begin, file_end);
  SC_ASSERT(image.text_end <= image.rodata_end && image.data_end == file_end,
            "{} has text to {}, constants to {} and data to {}, and its bytes end at {}", image.name,
            image.text_end, image.rodata_end, image.data_end, file_end);
}

void read_symbols(const SpuElf& elf, const std::vector<SpuElf::Section>& sections, KernelImage& image) {
  elf.for_each_symbol(
      sections, [&](std::string_view name, std::uint32_t address, std::uint32_t bytes, unsigned type) {
        if (address < image.begin || address >= image.sizes.end || bytes > image.sizes.end - address) return;
        const bool is_code = address >= image.text_begin && address < image.text_end;
        // Assembly sources seldom say what a label is.
        if (type == STT_FUNC || (type == STT_NOTYPE && is_code)) {
          image.functions.push_back({demangled(name), {address}, bytes});
        } else if (type == STT_OBJECT && bytes != 0) {
          image.objects.push_back({demangled(name), {address}, bytes});
        }
      });
  const auto by_place = [](const ImageObject& a, const ImageObject& b) {
    return std::pair(a.begin, a.bytes) < std::pair(b.begin, b.bytes);
  };
  std::ranges::stable_sort(image.functions, by_place);
  std::ranges::stable_sort(image.objects, by_place);
}

/// What spu_kernels/sdk/spu/ls.ld declares of a kernel, six words.
void read_declaration(const SpuElf& elf, const std::vector<SpuElf::Section>& sections, KernelImage& image) {
  constexpr std::uint32_t kMagic = 0x53434B32, kWords = 6;
  const auto declaration = elf.find(sections, ".softcell.kernel");
  if (!declaration) return;
  if (declaration->bytes != kWords * sizeof(std::uint32_t) || elf.word_of(*declaration, 0) != kMagic)
    elf.refuse("its .softcell.kernel section is of another version of softcell_add_spu_kernel");
  if (elf.word_of(*declaration, 3) != image.sizes.end) elf.refuse("its sections do not end where _end says");
  image.sizes.stack = elf.word_of(*declaration, 1);
  image.sizes.budget = elf.word_of(*declaration, 2);
  image.main = elf.word_of(*declaration, 5);
  const bool is_above = image.begin != kEnvironmentBytes;
  if (is_above) {
    image.stack_top = image.begin;
    image.sizes.from = image.begin;
  }
  const std::uint32_t room = is_above ? image.begin : dma::kLocalStoreBytes - image.sizes.end;
  if (image.sizes.stack == 0 || image.sizes.stack % dma::kQuadwordBytes != 0 || image.sizes.stack > room)
    elf.refuse("its declared stack of " + std::to_string(image.sizes.stack) +
               " bytes is not a positive multiple of 16 that fits beside the image in 256 KB");
  if (image.main < image.text_begin || image.main >= image.text_end || image.main % 4 != 0)
    elf.refuse("its main at " + std::to_string(image.main) + " is no instruction");
}

}  // namespace

bool is_spu_program(std::span<const std::byte> elf) {
  constexpr std::size_t kMachine = offsetof(Elf32_Ehdr, e_machine);
  const auto at = [&](std::size_t offset) { return static_cast<unsigned>(elf[offset]); };
  return elf.size() >= kMachine + 2 && std::memcmp(elf.data(), ELFMAG, SELFMAG) == 0 &&
         at(EI_CLASS) == ELFCLASS32 && at(EI_DATA) == ELFDATA2MSB && at(kMachine) << 8 == 0 &&
         at(kMachine + 1) == EM_SPU;
}

KernelImage load_spu_program(std::string_view name, std::span<const std::byte> file) {
  const SpuElf elf(name, file);
  const auto segments = loaded_segments(elf);
  const auto sections = elf.sections();
  KernelImage image;
  image.name = name;
  image.machine = Machine::kSpu;
  image.begin = segments.front().address;
  image.entry = elf.entry();
  copy_bytes(elf, segments, image);
  find_parts(segments, sections, image);
  const std::uint32_t end = segments.back().end();
  const std::uint32_t whole_end = (end + dma::kQuadwordBytes - 1) / dma::kQuadwordBytes * dma::kQuadwordBytes;
  SC_ASSERT(image.begin + image.bytes.size() <= end && whole_end <= dma::kLocalStoreBytes,
            "{} has {} bytes from {} on and ends at {}", name, image.bytes.size(), image.begin, end);
  image.sizes = {.text = image.text_end - image.text_begin,
                 .rodata = image.rodata_end - image.rodata_begin,
                 .data = image.data_end - image.data_begin,
                 .bss = end - image.begin - static_cast<std::uint32_t>(image.bytes.size()),
                 .stack = dma::kLocalStoreBytes - whole_end,
                 .budget = dma::kLocalStoreBytes,
                 .from = 0,
                 .end = whole_end};
  const bool is_loaded = std::ranges::any_of(
      segments, [&](const auto& s) { return image.entry >= s.address && image.entry < s.file_end(); });
  if (!is_loaded || image.entry % 4 != 0)
    elf.refuse("its entry at " + std::to_string(image.entry) + " is no instruction of what is loaded");
  read_declaration(elf, sections, image);
  read_symbols(elf, sections, image);
  image.elf = std::make_shared<const std::vector<std::byte>>(file.begin(), file.end());
  return image;
}

}  // namespace softcell::ls_sim
