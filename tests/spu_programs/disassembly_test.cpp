// Whole programs disassembled: what GNU objdump printed once stands in disassembly.txt.

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "interpreter/disassembler.h"

namespace softcell::spu_programs {
namespace {

TEST(Disassembler, PrintsWholeProgramsAsGnuObjdumpDoes) {
  std::ifstream file(SPU_DISASSEMBLY);
  int lines = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream fields(line);
    std::uint32_t address = 0, word = 0;
    std::string text;
    fields >> std::hex >> address >> word >> std::ws;
    std::getline(fields, text);
    EXPECT_EQ(ls_sim::interpreter::disassemble(ls_sim::interpreter::decode(word), address), text)
        << std::hex << word << " at " << address;
    ++lines;
  }
  EXPECT_GT(lines, 1500);
}

}  // namespace
}  // namespace softcell::spu_programs
