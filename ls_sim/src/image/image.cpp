#include "softcell/ls_sim/image.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "elf_file.h"
#include "function_names.h"
#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {
namespace {

constexpr std::uint32_t kDeclarationMagic = 0x324B4353;  // "SCK2", written by ls.ld

/// The section that ls.ld writes for the loader.
struct Declaration {
  std::uint32_t magic, stack_bytes, budget_bytes, end, kind;
};
constexpr std::uint32_t kChecked = 1, kProgram = 2;  // bits of the kind

/// The one loadable segment that ls.ld makes, checked against the local store.
Elf64_Phdr read_segment(const ElfFile& elf) {
  auto segments = elf.loadable_segments();
  std::sort(segments.begin(), segments.end(), [](const Elf64_Phdr& a, const Elf64_Phdr& b) {
    return std::pair(a.p_vaddr, a.p_memsz) < std::pair(b.p_vaddr, b.p_memsz);
  });
  for (std::size_t i = 1; i < segments.size(); ++i) {
    if (segments[i].p_vaddr - segments[i - 1].p_vaddr < segments[i - 1].p_memsz)
      elf.refuse("its loadable segments overlap at address " + std::to_string(segments[i].p_vaddr));
  }
  if (segments.size() != 1) {
    elf.refuse("it has " + std::to_string(segments.size()) + " loadable segments; ls.ld makes exactly one");
  }
  const Elf64_Phdr& segment = segments.front();
  if (segment.p_filesz > segment.p_memsz)
    elf.refuse("its segment holds more bytes in the file than in memory");
  if (segment.p_vaddr < kEnvironmentBytes || segment.p_vaddr >= dma::kLocalStoreBytes ||
      segment.p_vaddr % dma::kLineBytes != 0) {
    elf.refuse("its segment does not begin at a multiple of 128 from local-store address 0x80 on");
  }
  if (segment.p_memsz > dma::kLocalStoreBytes - segment.p_vaddr) {
    elf.refuse("it takes " + std::to_string(segment.p_memsz) +
               " bytes and passes the 256 KB of a local store");
  }
  return segment;
}

Declaration read_declaration(const ElfFile& elf, const Elf64_Phdr& segment) {
  const std::uint64_t segment_end = segment.p_vaddr + segment.p_memsz;
  const Elf64_Shdr section = elf.find(".softcell.kernel").header;
  if (section.sh_size < sizeof(std::uint32_t)) {
    elf.refuse("it has no .softcell.kernel section; link it with softcell_add_spu_kernel");
  }
  const char* const what = "the .softcell.kernel section";
  if (section.sh_size != sizeof(Declaration) ||
      elf.table<std::uint32_t>(section.sh_offset, 1, what).front() != kDeclarationMagic) {
    elf.refuse("its .softcell.kernel section is of another version of softcell_add_spu_kernel");
  }
  const auto declared = elf.table<Declaration>(section.sh_offset, 1, what).front();
  if (declared.end < segment_end || declared.end - segment_end >= dma::kLineBytes)
    elf.refuse("its sections do not end where _end says");
  const std::uint64_t room = segment.p_vaddr == kEnvironmentBytes
                                 ? dma::kLocalStoreBytes - std::min(declared.end, dma::kLocalStoreBytes)
                                 : segment.p_vaddr - kEnvironmentBytes;
  if (declared.end > dma::kLocalStoreBytes || declared.stack_bytes == 0 ||
      declared.stack_bytes % dma::kQuadwordBytes != 0 || declared.stack_bytes > room) {
    elf.refuse("its declared stack of " + std::to_string(declared.stack_bytes) +
               " bytes is not a positive multiple of 16 that fits beside the image in 256 KB");
  }
  if (declared.kind > (kChecked | kProgram))
    elf.refuse("its .softcell.kernel section says neither checked nor unchecked, kernel nor program");
  return declared;
}

/// True for what depends on where the image lies. All else the link has done for good.
bool is_absolute(const Elf64_Rela& relocation) {
  switch (ELF64_R_TYPE(relocation.r_info)) {
    case R_X86_64_NONE:
    case R_X86_64_PC32:
    case R_X86_64_PLT32:
    case R_X86_64_GOTPCREL:
    case R_X86_64_GOTPCRELX:
    case R_X86_64_REX_GOTPCRELX:
      return false;
    default:
      return true;
  }
}

/// Words of a program that hold an address in it. The link has noted them in .rela.dyn, and writes their
/// addends there only: they are stored in the image's bytes here.
std::vector<dma::LocalStoreAddress> apply_addends(const ElfFile& elf, KernelImage& image) {
  std::vector<dma::LocalStoreAddress> words;
  for (const auto& relocation : elf.relocations(elf.find(".rela.dyn"))) {
    const std::uint64_t offset = relocation.r_offset - image.begin;
    const auto addend = static_cast<std::uint32_t>(relocation.r_addend);
    if (ELF64_R_TYPE(relocation.r_info) != R_X86_64_RELATIVE || relocation.r_offset < image.begin ||
        image.bytes.size() < sizeof addend || offset > image.bytes.size() - sizeof addend ||
        addend > dma::kLocalStoreBytes) {
      elf.refuse("it holds a relocation that is no address of 32 bits in the program");
    }
    std::memcpy(image.bytes.data() + offset, &addend, sizeof addend);
    words.push_back({static_cast<std::uint32_t>(relocation.r_offset)});
  }
  return words;
}

/// The link keeps its relocations (--emit-relocs): a debugger needs those of the debug information. Those of
/// the image itself must be ones that the link has done for good.
void refuse_relocations(const ElfFile& elf) {
  for (const ElfFile::Section& section : elf.sections()) {
    const auto& [name, header] = section;
    if ((header.sh_type != SHT_RELA && header.sh_type != SHT_REL) || header.sh_size == 0) continue;
    if (header.sh_type == SHT_REL) {
      elf.refuse("its section " + std::string(name) +
                 " has relocations without addends (SHT_REL); an x86-64 linker makes SHT_RELA ones");
    }
    const bool is_loaded = (header.sh_flags & SHF_ALLOC) != 0 || name == ".rela.dyn";
    const bool is_of_image = header.sh_info < elf.sections().size() &&
                             (elf.sections()[header.sh_info].header.sh_flags & SHF_ALLOC) != 0;
    const auto relocations = elf.relocations(section);
    if (is_loaded || (is_of_image && std::any_of(relocations.begin(), relocations.end(), is_absolute)))
      elf.refuse("a relocation is left: an absolute pointer is stored in its static data");
  }
}

/// The four sections that live in the local store, as ls.ld orders them.
struct Layout {
  ElfFile::Section text, rodata, data, bss;
};

Layout read_layout(const ElfFile& elf, const Elf64_Phdr& segment) {
  const Layout layout{elf.find(".text"), elf.find(".rodata"), elf.find(".data"), elf.find(".bss")};
  const std::uint64_t file_end = segment.p_vaddr + segment.p_filesz;
  const std::uint64_t memory_end = segment.p_vaddr + segment.p_memsz;
  std::uint64_t free_from = segment.p_vaddr;
  for (const ElfFile::Section* section : {&layout.text, &layout.rodata, &layout.data, &layout.bss}) {
    if (section->header.sh_size == 0) continue;
    const std::uint64_t end = section == &layout.bss ? memory_end : file_end;
    if (section->header.sh_addr < free_from || section->end() > end) {
      elf.refuse("its section " + std::string(section->name) +
                 " overlaps another or lies outside the segment that is loaded");
    }
    free_from = section->end();
  }
  return layout;
}

/// The variables or functions, in order of address.
/// @param type  STT_OBJECT or STT_FUNC
std::vector<ImageObject> read_objects(const ElfFile& elf, unsigned type, std::uint32_t begin,
                                      std::uint32_t end) {
  std::vector<ImageObject> objects;
  for (const auto& [name, symbol] : elf.symbols()) {
    if (ELF64_ST_TYPE(symbol.st_info) != type || symbol.st_size == 0) continue;
    if (symbol.st_value < begin || symbol.st_value >= end || symbol.st_size > end - symbol.st_value) {
      elf.refuse((type == STT_FUNC ? "its function " : "its variable ") + demangled(name) +
                 " lies outside it");
    }
    objects.push_back({demangled(name),
                       {static_cast<std::uint32_t>(symbol.st_value)},
                       static_cast<std::uint32_t>(symbol.st_size)});
  }
  std::sort(objects.begin(), objects.end(), [](const ImageObject& a, const ImageObject& b) {
    return std::pair(a.begin, a.bytes) < std::pair(b.begin, b.bytes);
  });
  return objects;
}

std::uint32_t narrow(std::uint64_t value) {
  SC_ASSERT(value <= dma::kLocalStoreBytes, "{} is checked against the local store, and passes it", value);
  return static_cast<std::uint32_t>(value);
}

}  // namespace

KernelImage load_image(std::string_view name, std::span<const std::byte> file) {
  const ElfFile elf(name, file);
  const Elf64_Phdr segment = read_segment(elf);
  const std::uint64_t file_end = segment.p_vaddr + segment.p_filesz;
  const Declaration declared = read_declaration(elf, segment);
  const bool is_program = (declared.kind & kProgram) != 0;
  if (!is_program) refuse_relocations(elf);
  const Layout layout = read_layout(elf, segment);
  const std::uint64_t entry = elf.header().e_entry;
  if (entry < layout.text.header.sh_addr || entry >= layout.text.end())
    elf.refuse("its entry lies outside its text");

  KernelImage image;
  image.name = name;
  image.sizes = {.text = narrow(layout.text.header.sh_size),
                 .rodata = narrow(layout.rodata.header.sh_size),
                 .data = narrow(layout.data.header.sh_size),
                 .bss = narrow(layout.bss.header.sh_size),
                 .stack = declared.stack_bytes,
                 .budget = declared.budget_bytes,
                 .from = segment.p_vaddr == kEnvironmentBytes ? 0 : narrow(segment.p_vaddr),
                 .end = declared.end};
  image.begin = narrow(segment.p_vaddr);
  if (image.begin != kEnvironmentBytes) image.stack_top = image.begin;
  image.entry = narrow(entry);
  image.main = image.entry;
  image.text_begin = narrow(layout.text.header.sh_addr);
  image.text_end = narrow(layout.text.end());
  image.rodata_begin = narrow(image.sizes.rodata != 0 ? layout.rodata.header.sh_addr : image.text_end);
  image.rodata_end = image.rodata_begin + image.sizes.rodata;
  image.data_begin = narrow(image.sizes.data != 0 ? layout.data.header.sh_addr : file_end);
  image.data_end = image.data_begin + image.sizes.data;
  image.objects = read_objects(elf, STT_OBJECT, image.begin, declared.end);
  image.functions = read_objects(elf, STT_FUNC, image.begin, declared.end);
  image.checked = (declared.kind & kChecked) != 0;
  image.program = is_program;
  const auto bytes = elf.slice(segment.p_offset, segment.p_filesz, "its segment");
  image.bytes.assign(bytes.begin(), bytes.end());
  if (is_program) image.relocations = apply_addends(elf, image);
  SC_ASSERT(image.begin <= image.text_begin && image.data_begin <= image.data_end &&
                image.data_end <= image.sizes.end,
            "{} begins at {} and ends at {}, with text at {} and data at {} to {}", name, image.begin,
            image.sizes.end, image.text_begin, image.data_begin, image.data_end);
  SC_ASSERT(std::ranges::is_sorted(image.objects, {}, &ImageObject::begin),
            "the {} variables of {} are out of order", image.objects.size(), name);
  image.elf = std::make_shared<const std::vector<std::byte>>(file.begin(), file.end());
  return image;
}

std::span<const std::byte> image_section(std::span<const std::byte> file, std::string_view section) {
  try {
    const ElfFile elf("image", file);
    const Elf64_Shdr header = elf.find(section).header;
    return elf.slice(header.sh_offset, header.sh_size, "a section");
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace softcell::ls_sim
