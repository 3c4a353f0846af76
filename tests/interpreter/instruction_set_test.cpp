// The table of instructions, the decoder and the disassembler made from it.

#include "interpreter/instruction_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/disassembler.h"

namespace softcell::ls_sim::interpreter {
namespace {

struct GoldenLine {
  std::uint32_t address = 0, word = 0;
  std::string text;
};

std::vector<GoldenLine> golden_lines() {
  std::ifstream file(SOFTCELL_DISASSEMBLY);
  std::vector<GoldenLine> lines;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream fields(line);
    GoldenLine entry;
    fields >> std::hex >> entry.address >> entry.word >> std::ws;
    std::getline(fields, entry.text);
    lines.push_back(entry);
  }
  return lines;
}

TEST(InstructionSet, HasExactly199InstructionsWithDifferentNames) {
  EXPECT_EQ(kInstructions, 199u);
  std::set<std::string_view> names;
  for (const InstructionInfo& info : kInstructionTable) names.insert(info.mnemonic);
  EXPECT_EQ(names.size(), 199u);
}

TEST(InstructionSet, FillsTheOpcodesOfTheArchitecture) {
  int valid = 0;
  for (std::uint32_t top = 0; top < 2048; ++top) valid += decode(top << 21).mnemonic != Mnemonic::invalid;
  EXPECT_EQ(valid, 1264);  // of 2048; no two rows share one, or the decoder would not compile
}

TEST(InstructionSet, DecodesEachRowToItself) {
  for (std::size_t row = 0; row < kInstructions; ++row) {
    const InstructionInfo& info = kInstructionTable[row];
    const auto word = std::uint32_t{info.opcode} << (32 - info.opcode_bits);
    EXPECT_EQ(decode(word).mnemonic, static_cast<Mnemonic>(row)) << info.mnemonic;
    EXPECT_EQ(decode(word | ((1u << (32 - info.opcode_bits)) - 1)).mnemonic, static_cast<Mnemonic>(row))
        << info.mnemonic << " with all other bits set";
  }
}

TEST(InstructionSet, WidthsOfOpcodesAreThoseOfTheirFormats) {
  for (const InstructionInfo& info : kInstructionTable) {
    constexpr int kBits[] = {4, 11, 11, 10, 8, 9, 7, 7, 11};  // in the order of Format
    EXPECT_EQ(info.opcode_bits, kBits[static_cast<int>(info.format)]) << info.mnemonic;
    EXPECT_LT(info.opcode, 1u << info.opcode_bits) << info.mnemonic;
  }
}

TEST(InstructionSet, SaysWhichInstructionsReadTheirTarget) {
  // [SPU-ISA]: stores, conditional branches, writes to channels and registers, and these.
  const std::set<std::string_view> by_name = {"iohl", "addx", "cgx",   "sfx",   "bgx",  "mpyhha", "mpyhhau",
                                              "dfma", "dfms", "dfnms", "dfnma", "wrch", "mtspr",  "stopd"};
  for (const InstructionInfo& info : kInstructionTable) {
    const bool is_conditional = info.kind == Kind::kJump && info.mnemonic.find('z') != std::string_view::npos;
    const bool expected = by_name.contains(info.mnemonic) || info.kind == Kind::kStore || is_conditional;
    EXPECT_EQ((info.reads & reads::kT) != 0, expected) << info.mnemonic;
  }
}

TEST(InstructionSet, ExecutesArithmeticInTheEvenPipe) {
  using enum Mnemonic;
  for (const Mnemonic even :
       {a, fma, dfma, mpy, fi, shl, rotmai, selb, clgt, heq, cntb, nop, ila, xswd, cflts})
    EXPECT_TRUE(is_even_pipe(info_of(even).latency)) << info_of(even).mnemonic;
  for (const Mnemonic odd :
       {lqd, stqr, shufb, rotqby, fsmbi, cwd, gb, orx, frest, br, bisl, stop, sync, rdch, hbrr, lnop})
    EXPECT_FALSE(is_even_pipe(info_of(odd).latency)) << info_of(odd).mnemonic;
}

TEST(Disassembler, PrintsWhatGnuObjdumpPrints) {
  const std::vector<GoldenLine> lines = golden_lines();
  ASSERT_EQ(lines.size(), 4 * kInstructions);
  for (const GoldenLine& line : lines) {
    EXPECT_EQ(disassemble(decode(line.word), line.address), line.text) << std::hex << line.word;
  }
}

TEST(Disassembler, PrintsWordsThatAreNoInstructionsAsNumbers) {
  EXPECT_EQ(disassemble(decode(0xAF123456), 0), ".long 0xaf123456");
}

}  // namespace
}  // namespace softcell::ls_sim::interpreter
