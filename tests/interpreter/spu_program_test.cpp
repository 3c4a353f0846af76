// The loader of SPU executables, with files that are damaged on purpose.

#include <elf.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim {
namespace {

std::vector<std::byte> selfcheck() {
  std::ifstream file(SOFTCELL_SPU_PROGRAMS "/selfcheck.O2.elf", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

class Damaged : public testing::Test {
 protected:
  void set_word(std::size_t at, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes_[at + i] = static_cast<std::byte>(value >> (24 - 8 * i));
  }
  void set_half(std::size_t at, std::uint32_t value) {
    for (int i = 0; i < 2; ++i) bytes_[at + i] = static_cast<std::byte>(value >> (8 - 8 * i));
  }
  /// The place of a field of the first loadable segment.
  std::size_t segment(std::size_t field, std::size_t number = 0) const {
    return sizeof(Elf32_Ehdr) + number * sizeof(Elf32_Phdr) + field;
  }
  void expect_refusal(const std::string& reason) const {
    try {
      load_spu_program("p", bytes_);
      FAIL() << "loaded; expected: " << reason;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).rfind("SPU program p: ", 0), 0u) << error.what();
    }
  }
  std::vector<std::byte> bytes_ = selfcheck();
};

TEST_F(Damaged, NotAtAllLoads) {
  const KernelImage image = load_spu_program("p", bytes_);
  EXPECT_EQ(image.machine, Machine::kSpu);
  EXPECT_EQ(image.begin, 0x80u);
  EXPECT_EQ(image.entry, 0x3D0u);
  EXPECT_GE(image.sizes.end, image.begin + image.bytes.size());
  EXPECT_EQ(image.sizes.end + image.sizes.stack, dma::kLocalStoreBytes);
  EXPECT_TRUE(is_spu_program(bytes_));
}

TEST_F(Damaged, ByCuttingItAnywhereIsRefusedOrHarmless) {
  for (std::size_t size = 0; size < bytes_.size(); ++size) {
    try {
      load_spu_program("p", std::span(bytes_).first(size));
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("SPU program p: ", 0), 0u) << error.what();
    }
  }
}

TEST_F(Damaged, MagicOrMachine) {
  set_half(offsetof(Elf32_Ehdr, e_machine), 21);
  expect_refusal("machine 23");
  bytes_ = selfcheck();
  bytes_[EI_DATA] = std::byte{ELFDATA2LSB};
  expect_refusal("big-endian");
  bytes_ = selfcheck();
  bytes_[0] = std::byte{0};
  expect_refusal("not an ELF file");
}

TEST_F(Damaged, ObjectFilesAreNotPrograms) {
  set_half(offsetof(Elf32_Ehdr, e_type), ET_REL);
  expect_refusal("not a linked executable");
}

TEST_F(Damaged, SegmentsOutsideTheLocalStore) {
  set_word(segment(offsetof(Elf32_Phdr, p_vaddr)), 0x3FF00);
  expect_refusal("passes the 256 KB");
  bytes_ = selfcheck();
  set_word(segment(offsetof(Elf32_Phdr, p_memsz)), 0xFFFFFFFF);
  expect_refusal("passes the 256 KB");
}

TEST_F(Damaged, SegmentsOutsideTheFile) {
  set_word(segment(offsetof(Elf32_Phdr, p_offset)), 0xFFFFFFF0);
  expect_refusal("truncated");
}

TEST_F(Damaged, MoreInTheFileThanInMemory) {
  set_word(segment(offsetof(Elf32_Phdr, p_memsz)), 16);
  expect_refusal("more bytes in the file");
}

TEST_F(Damaged, Overlays) {
  set_word(segment(offsetof(Elf32_Phdr, p_flags)), 0x08000005);
  expect_refusal("overlays");
}

TEST_F(Damaged, NothingToLoad) {
  set_half(offsetof(Elf32_Ehdr, e_phnum), 0);
  expect_refusal("no loadable segment");
}

TEST_F(Damaged, Entry) {
  set_word(offsetof(Elf32_Ehdr, e_entry), 0x3FF00);
  expect_refusal("entry");
  set_word(offsetof(Elf32_Ehdr, e_entry), 0x82);
  expect_refusal("entry");
}

TEST_F(Damaged, TablesOfUnknownRecords) {
  set_half(offsetof(Elf32_Ehdr, e_phentsize), 56);
  expect_refusal("unknown size");
}

}  // namespace
}  // namespace softcell::ls_sim
