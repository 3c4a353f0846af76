#include "softcell/ls_sim/image.h"

#include <elf.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "test_images.h"

namespace softcell::ls_sim {
namespace {

using Bytes = std::vector<std::byte>;

Bytes good_elf() {
  const auto file = test_elf("echo_arguments");
  return {file.begin(), file.end()};
}

template <typename T>
void change(Bytes& file, std::size_t offset, const std::function<void(T&)>& edit) {
  T record;
  std::memcpy(&record, file.data() + offset, sizeof record);
  edit(record);
  std::memcpy(file.data() + offset, &record, sizeof record);
}

std::size_t load_segment_offset(const Bytes& file) {
  Elf32_Ehdr header;
  std::memcpy(&header, file.data(), sizeof header);
  for (std::size_t i = 0;; ++i) {
    const std::size_t at = header.e_phoff + i * sizeof(Elf32_Phdr);
    Elf32_Phdr segment;
    std::memcpy(&segment, file.data() + at, sizeof segment);
    if (segment.p_type == PT_LOAD) return at;
  }
}

template <typename T>
T read(const Bytes& file, std::size_t offset) {
  T record;
  std::memcpy(&record, file.data() + offset, sizeof record);
  return record;
}

/// The offset in the file of the section header with that name.
std::size_t section_offset(const Bytes& file, const std::string& name) {
  const auto header = read<Elf32_Ehdr>(file, 0);
  const auto at = [&](std::size_t i) { return header.e_shoff + i * sizeof(Elf32_Shdr); };
  const auto names = read<Elf32_Shdr>(file, at(header.e_shstrndx));
  for (std::size_t i = 0; i < header.e_shnum; ++i) {
    const auto* text = file.data() + names.sh_offset + read<Elf32_Shdr>(file, at(i)).sh_name;
    if (name == reinterpret_cast<const char*>(text)) return at(i);
  }
  throw std::logic_error("no section " + name);
}

/// Moves the program headers to the end of the file, with an edited copy of the loadable one.
void append_segment(Bytes& file, const std::function<void(Elf32_Phdr&)>& edit) {
  const auto first = read<Elf32_Phdr>(file, load_segment_offset(file));
  change<Elf32_Ehdr>(file, 0, [&](Elf32_Ehdr& h) {
    h.e_phoff = static_cast<Elf32_Off>(file.size());
    h.e_phnum = 2;
  });
  file.resize(file.size() + 2 * sizeof first);
  for (const std::size_t from_end : {std::size_t{2}, std::size_t{1}}) {
    change<Elf32_Phdr>(file, file.size() - from_end * sizeof first, [&](Elf32_Phdr& s) {
      s = first;
      if (from_end == 1) edit(s);
    });
  }
}

std::string refusal(const Bytes& file) {
  try {
    load_image("k", file);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LoadImage, ReadsSizesAndDeclarationsOfALinkedKernel) {
  const KernelImage image = test_image("remembers");
  EXPECT_EQ(image.name, "remembers");
  EXPECT_EQ(image.sizes.stack, 2048u);
  EXPECT_EQ(image.sizes.budget, 24576u);
  EXPECT_EQ(image.sizes.data, 4u);
  EXPECT_GE(image.sizes.bss, 132u);
  EXPECT_GT(image.sizes.text, 0u);
  EXPECT_GE(image.entry, kEnvironmentBytes);
  EXPECT_EQ(image.sizes.total(), image.sizes.end + 2048u);
  EXPECT_EQ(image.data_end - image.data_begin, 4u);
}

TEST(LoadImage, ReadsAnImageThatLiesElsewhere) {
  const KernelImage image = test_image("resides");
  EXPECT_EQ(image.begin, 0x20000u);
  EXPECT_EQ(image.text_begin, 0x20000u);
  EXPECT_EQ(image.stack_top, 0x20000u) << "its stack grows down from where it begins";
  EXPECT_EQ(image.sizes.from, 0x20000u);
  EXPECT_EQ(image.sizes.total(), image.sizes.end - 0x20000 + 1024)
      << "what lies below is not its own, nor is the environment";
  EXPECT_EQ(image.bytes.size(), image.data_end - image.begin);
  EXPECT_GE(image.entry, image.text_begin);
  EXPECT_LT(image.entry, image.text_end);
  for (const ImageObject& object : image.objects) EXPECT_GE(object.begin.value, image.data_begin);
}

TEST(LoadImage, TheCheckedImageLiesWhereTheOtherDoes) {
  const KernelImage image = test_image("resides_checked");
  EXPECT_TRUE(image.checked);
  EXPECT_EQ(image.begin, 0x20000u);
  EXPECT_EQ(image.stack_top, 0x20000u);
}

TEST(LoadImage, RefusesAnImageThatLiesWhereNoneCan) {
  for (const std::uint32_t place : {0x0u, 0x20010u, 0x20040u, 0x40000u, 0xF0020000u}) {
    const auto resident = test_elf("resides");
    Bytes file(resident.begin(), resident.end());
    change<Elf32_Phdr>(file, load_segment_offset(file), [&](Elf32_Phdr& s) { s.p_vaddr = place; });
    EXPECT_NE(refusal(file).find("multiple of 128 from local-store address 0x80 on"), std::string::npos)
        << place << ": " << refusal(file);
  }
}

TEST(LoadImage, RefusesASegmentThatIsNotWhereItsSectionsAre) {
  for (const std::uint32_t place : {0x80u, 0x10000u, 0x30000u}) {
    const auto resident = test_elf("resides");
    Bytes file(resident.begin(), resident.end());
    change<Elf32_Phdr>(file, load_segment_offset(file), [&](Elf32_Phdr& s) { s.p_vaddr = place; });
    EXPECT_NE(refusal(file).find("do not end where _end says"), std::string::npos) << refusal(file);
  }
}

TEST(LoadImage, RefusesAStackThatHasNoRoomBelowTheImage) {
  const auto resident = test_elf("resides");
  for (const auto& [stack, fits] : {std::pair{0x20000u - 0x80u, true}, {0x20000u - 0x70u, false}}) {
    Bytes file(resident.begin(), resident.end());
    const std::size_t at = read<Elf32_Shdr>(file, section_offset(file, ".softcell.kernel")).sh_offset;
    change<std::uint32_t>(file, at + 4, [wanted = stack](std::uint32_t& word) { word = wanted; });
    EXPECT_EQ(refusal(file) == "accepted", fits) << refusal(file);
  }
}

TEST(LoadImage, RefusesWhatIsNoElfFile) {
  EXPECT_EQ(refusal(Bytes(100, std::byte{7})), "kernel image k: not an ELF file");
  EXPECT_NE(refusal({}).find("truncated: the ELF header"), std::string::npos);
}

TEST(LoadImage, RefusesAnotherMachine) {
  Bytes file = good_elf();
  change<Elf32_Ehdr>(file, 0, [](Elf32_Ehdr& h) { h.e_machine = 23; });
  EXPECT_NE(refusal(file).find("ELF machine 23"), std::string::npos);
}

TEST(LoadImage, NamesTheMachineOfWhatItRefuses) {
  const struct Case {
    unsigned machine;
    const char* name;
  } cases[] = {{EM_PPC64, "ELF machine 21 (a PowerPC"},
               {EM_SPU << 8, "ELF machine 5888 (that of a real SPU with its bytes swapped"}};
  for (const Case& other : cases) {
    Bytes file = good_elf();
    change<Elf32_Ehdr>(file, 0, [&](Elf32_Ehdr& h) { h.e_machine = static_cast<Elf32_Half>(other.machine); });
    EXPECT_NE(refusal(file).find(other.name), std::string::npos) << refusal(file);
  }
}

TEST(LoadImage, RefusesAnImageWith64BitPointers) {
  Bytes file = good_elf();
  change<Elf32_Ehdr>(file, 0, [](Elf32_Ehdr& h) { h.e_ident[EI_CLASS] = ELFCLASS64; });
  EXPECT_NE(refusal(file).find("with 64-bit pointers"), std::string::npos);
}

TEST(LoadImage, RefusesEveryTruncation) {
  const Bytes whole = good_elf();
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    EXPECT_NE(refusal(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))), "accepted")
        << size;
  }
}

TEST(LoadImage, RefusesASegmentPast256Kilobytes) {
  Bytes file = good_elf();
  change<Elf32_Phdr>(file, load_segment_offset(file), [](Elf32_Phdr& s) { s.p_memsz = 256 * 1024; });
  EXPECT_NE(refusal(file).find("256 KB"), std::string::npos);
}

TEST(LoadImage, RefusesASegmentElsewhere) {
  Bytes file = good_elf();
  change<Elf32_Phdr>(file, load_segment_offset(file), [](Elf32_Phdr& s) { s.p_vaddr = 0x40; });
  EXPECT_NE(refusal(file).find("0x80"), std::string::npos);
}

TEST(LoadImage, RefusesMoreBytesInTheFileThanInMemory) {
  Bytes file = good_elf();
  change<Elf32_Phdr>(file, load_segment_offset(file), [](Elf32_Phdr& s) { s.p_filesz = s.p_memsz + 1; });
  EXPECT_NE(refusal(file).find("more bytes in the file than in memory"), std::string::npos);
}

TEST(LoadImage, RefusesSegmentsThatOverlap) {
  Bytes file = good_elf();
  append_segment(file, [](Elf32_Phdr& s) { s.p_vaddr += 16; });
  EXPECT_EQ(refusal(file), "kernel image k: its loadable segments overlap at address 144");
}

TEST(LoadImage, RefusesTwoSegmentsSideBySide) {
  Bytes file = good_elf();
  append_segment(file, [](Elf32_Phdr& s) { s.p_vaddr += 0x10000; });
  EXPECT_EQ(refusal(file), "kernel image k: it has 2 loadable segments; ls.ld makes exactly one");
}

TEST(LoadImage, RefusesAnEntryOutsideTheText) {
  Bytes file = good_elf();
  change<Elf32_Ehdr>(file, 0, [](Elf32_Ehdr& h) { h.e_entry = 0x3FF00; });
  EXPECT_EQ(refusal(file), "kernel image k: its entry lies outside its text");
}

TEST(LoadImage, RefusesAnObjectFile) {
  Bytes file = good_elf();
  change<Elf32_Ehdr>(file, 0, [](Elf32_Ehdr& h) { h.e_type = ET_REL; });
  EXPECT_NE(refusal(file).find("not a linked program"), std::string::npos);
}

TEST(LoadImage, NamesARealSpuProgram) {
  Bytes file = good_elf();
  change<Elf32_Ehdr>(file, 0, [](Elf32_Ehdr& h) {
    h.e_ident[EI_CLASS] = ELFCLASS32;
    h.e_ident[EI_DATA] = ELFDATA2MSB;
    h.e_machine = EM_SPU << 8;  // as a little-endian host reads it
  });
  EXPECT_NE(refusal(file).find("ELF machine 23 (a real SPU)"), std::string::npos);
}

TEST(LoadImage, RefusesARelocation) {
  Bytes file = good_elf();
  change<Elf32_Shdr>(file, section_offset(file, ".bss"), [](Elf32_Shdr& s) { s.sh_type = SHT_RELA; });
  EXPECT_EQ(refusal(file),
            "kernel image k: a relocation is left: an absolute pointer is stored in its static data");
}

TEST(LoadImage, RefusesRelocationsWithoutAddends) {
  Bytes file = good_elf();
  change<Elf32_Shdr>(file, section_offset(file, ".rela.text"), [](Elf32_Shdr& s) { s.sh_type = SHT_REL; });
  EXPECT_EQ(refusal(file),
            "kernel image k: its section .rela.text has relocations without addends (SHT_REL); an x86-64 "
            "linker makes SHT_RELA ones");
}

TEST(LoadImage, RefusesAnAbsoluteAddressAmongTheRelocationsThatTheLinkKept) {
  Bytes file = good_elf();
  const auto table = read<Elf32_Shdr>(file, section_offset(file, ".rela.text"));
  ASSERT_NE(table.sh_size, 0u);
  change<Elf32_Rela>(file, table.sh_offset, [](Elf32_Rela& r) { r.r_info = ELF32_R_INFO(1, R_X86_64_64); });
  EXPECT_NE(refusal(file).find("a relocation is left"), std::string::npos);
}

TEST(LoadImage, RefusesSectionsThatOverlap) {
  Bytes file = good_elf();
  change<Elf32_Shdr>(file, section_offset(file, ".bss"),
                     [](Elf32_Shdr& section) { section.sh_addr = kEnvironmentBytes; });
  EXPECT_NE(refusal(file).find("its section .bss overlaps another"), std::string::npos);
}

TEST(LoadImage, RefusesSectionsOutsideTheSegment) {
  for (const std::uint32_t address : {0u, 0x3FFF0u, 0xFFFFFFF0u}) {
    Bytes file = good_elf();
    change<Elf32_Shdr>(file, section_offset(file, ".bss"), [&](Elf32_Shdr& s) { s.sh_addr = address; });
    EXPECT_NE(refusal(file).find("its section .bss overlaps another or lies outside"), std::string::npos);
  }
}

TEST(LoadImage, RefusesAbsurdSizes) {
  Bytes file = good_elf();
  change<Elf32_Shdr>(file, section_offset(file, ".text"), [](Elf32_Shdr& s) { s.sh_size = ~0u; });
  EXPECT_NE(refusal(file).find("its section .text overlaps another or lies outside"), std::string::npos);
  file = good_elf();
  change<Elf32_Ehdr>(file, 0, [](Elf32_Ehdr& h) { h.e_shoff = ~0u - 8; });
  EXPECT_NE(refusal(file).find("truncated: the section header table"), std::string::npos);
  file = good_elf();
  change<Elf32_Ehdr>(file, 0, [](Elf32_Ehdr& h) { h.e_phnum = 0xFFFF; });
  EXPECT_NE(refusal(file).find("truncated: the program header table"), std::string::npos);
}

TEST(LoadImage, RefusesDeclarationsThatCannotBe) {
  struct Case {
    std::size_t word;
    std::uint32_t value;
    const char* says;
  };
  for (const auto& [word, value, says] : {Case{0, 0x314B4353, "of another version"},
                                          {1, 0, "declared stack of 0 bytes"},
                                          {1, 24, "declared stack of 24 bytes"},
                                          {1, 0x40000, "declared stack of 262144 bytes"},
                                          {1, 0xFFFFFFF0, "declared stack of 4294967280 bytes"},
                                          {3, 0, "do not end where _end says"},
                                          {3, 0xFFFFFFF0, "do not end where _end says"},
                                          {4, 4, "neither checked nor unchecked"}}) {
    Bytes file = good_elf();
    const std::size_t at = read<Elf32_Shdr>(file, section_offset(file, ".softcell.kernel")).sh_offset;
    change<std::uint32_t>(file, at + word * 4, [wanted = value](std::uint32_t& w) { w = wanted; });
    EXPECT_NE(refusal(file).find(says), std::string::npos) << refusal(file);
  }
}

TEST(LoadImage, RefusesAnImageWithoutDeclaration) {
  Bytes file = good_elf();
  change<Elf32_Shdr>(file, section_offset(file, ".softcell.kernel"), [](Elf32_Shdr& s) { s.sh_name = 0; });
  EXPECT_NE(refusal(file).find("no .softcell.kernel section"), std::string::npos);
}

TEST(LoadImage, RefusesAVariableOutsideTheImage) {
  Bytes file = good_elf();
  const auto symbols = read<Elf32_Shdr>(file, section_offset(file, ".symtab"));
  change<Elf32_Sym>(file, symbols.sh_offset + sizeof(Elf32_Sym), [](Elf32_Sym& s) {
    s = {
        .st_name = 0, .st_value = 0x100, .st_size = ~0u, .st_info = STT_OBJECT, .st_other = 0, .st_shndx = 1};
  });
  EXPECT_EQ(refusal(file), "kernel image k: its variable  lies outside it");
}

TEST(LoadImage, KnowsSectionsAndVariablesByAddress) {
  const KernelImage image = test_image("remembers");
  EXPECT_EQ(image.text_begin, kEnvironmentBytes);
  EXPECT_EQ(image.text_end - image.text_begin, image.sizes.text);
  EXPECT_LE(image.text_end, image.rodata_begin);
  EXPECT_EQ(image.rodata_end - image.rodata_begin, image.sizes.rodata);
  EXPECT_LE(image.rodata_end, image.data_begin);
  ASSERT_EQ(image.objects.size(), 3u);
  EXPECT_EQ(image.objects[0].name, "in_data");
  EXPECT_EQ(image.objects[0].begin.value, image.data_begin);
  EXPECT_EQ(image.objects[0].bytes, 4u);
  EXPECT_LT(image.objects[1].begin, image.objects[2].begin);
  EXPECT_FALSE(image.checked);
  EXPECT_EQ(*image.elf, Bytes(test_elf("remembers").begin(), test_elf("remembers").end()));
}

TEST(LoadImage, SurvivesEveryChangedByteOfTheHeaders) {
  // A changed byte may be harmless; it must never read outside the file (the sanitizer builds watch) or throw
  // anything else.
  const Bytes whole = good_elf();
  for (std::size_t i = 0; i < 256 && i < whole.size(); ++i) {
    for (const int value : {0x00, 0x01, 0x7F, 0x80, 0xFF}) {
      Bytes file = whole;
      file[i] = static_cast<std::byte>(value);
      EXPECT_NO_THROW(refusal(file));
    }
  }
}

}  // namespace
}  // namespace softcell::ls_sim
