#include "softcell/ls_sim/image.h"

#include <elf.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
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
  Elf64_Ehdr header;
  std::memcpy(&header, file.data(), sizeof header);
  for (std::size_t i = 0;; ++i) {
    const std::size_t at = header.e_phoff + i * sizeof(Elf64_Phdr);
    Elf64_Phdr segment;
    std::memcpy(&segment, file.data() + at, sizeof segment);
    if (segment.p_type == PT_LOAD) return at;
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
  EXPECT_EQ(image.sizes.budget, 16384u);
  EXPECT_EQ(image.sizes.data, 4u);
  EXPECT_GE(image.sizes.bss, 132u);
  EXPECT_GT(image.sizes.text, 0u);
  EXPECT_GE(image.entry, kEnvironmentBytes);
  EXPECT_EQ(image.sizes.total(), image.sizes.end + 2048u);
  EXPECT_EQ(image.data_end - image.data_begin, 4u);
}

TEST(LoadImage, RefusesWhatIsNoElfFile) {
  EXPECT_EQ(refusal(Bytes(100, std::byte{7})), "kernel image k: not an ELF file");
  EXPECT_NE(refusal({}).find("truncated: the ELF header"), std::string::npos);
}

TEST(LoadImage, RefusesAnotherMachine) {
  Bytes file = good_elf();
  change<Elf64_Ehdr>(file, 0, [](Elf64_Ehdr& h) { h.e_machine = 23; });
  EXPECT_NE(refusal(file).find("ELF machine 23"), std::string::npos);
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
  change<Elf64_Phdr>(file, load_segment_offset(file), [](Elf64_Phdr& s) { s.p_memsz = 256 * 1024; });
  EXPECT_NE(refusal(file).find("256 KB"), std::string::npos);
}

TEST(LoadImage, RefusesASegmentElsewhere) {
  Bytes file = good_elf();
  change<Elf64_Phdr>(file, load_segment_offset(file), [](Elf64_Phdr& s) { s.p_vaddr = 0x40; });
  EXPECT_NE(refusal(file).find("0x80"), std::string::npos);
}

TEST(LoadImage, RefusesAnEntryOutsideTheText) {
  Bytes file = good_elf();
  change<Elf64_Ehdr>(file, 0, [](Elf64_Ehdr& h) { h.e_entry = 0x3FF00; });
  EXPECT_NE(refusal(file).find("entry"), std::string::npos);
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
