#include "spu_model/instruction.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "softcell/base/assert.h"
#include "spu_model/compares_and_branches.h"
#include "spu_model/control_and_channels.h"
#include "spu_model/double_precision.h"
#include "spu_model/estimates.h"
#include "spu_model/integer_and_logical.h"
#include "spu_model/loads_and_stores.h"
#include "spu_model/shifts_and_rotates.h"
#include "spu_model/single_precision.h"

namespace softcell::spu_model {

std::uint32_t Instruction::pattern() const {
  std::uint32_t result = 0;
  for (std::size_t i = 0; i < opcode.size(); ++i) {
    if (opcode[i] == '1') result |= 0x80000000u >> i;
  }
  return result;
}

std::uint32_t Instruction::mask() const { return ~(0xFFFFFFFFu >> opcode.size()); }

std::span<const Instruction> instructions() {
  static const Instruction all[] = {
#define SC_SPU_MODEL(mnemonic, format, opcode, definition, evidence, note) \
  Instruction(mnemonic, Format::format, opcode, &chapter::definition, Evidence::evidence, note),
#include "spu_model/instructions.def"
#undef SC_SPU_MODEL
  };
  return all;
}

const Instruction* decode(std::uint32_t word) {
  constexpr int kOpcodeBits = 11;  // at most
  static const auto kByOpcode = [] {
    std::array<const Instruction*, 1 << kOpcodeBits> rows{};
    for (std::uint32_t opcode = 0; opcode < rows.size(); ++opcode) {
      for (const Instruction& row : instructions()) {
        if ((opcode << (32 - kOpcodeBits) & row.mask()) == row.pattern()) rows.at(opcode) = &row;
      }
    }
    return rows;
  }();
  return kByOpcode.at(word >> (32 - kOpcodeBits));
}

const Instruction& instruction(std::string_view mnemonic) {
  const auto found = std::ranges::find(instructions(), mnemonic, &Instruction::mnemonic);
  SC_ASSERT(found != instructions().end(), "no instruction is named {}", mnemonic);
  return *found;
}

bool is_enhanced_double(const Instruction& instruction) {
  constexpr std::string_view kNames[] = {"dfceq", "dfcmeq", "dfcgt", "dfcmgt", "dftsv"};
  return std::ranges::find(kNames, instruction.mnemonic) != std::end(kNames);
}

}  // namespace softcell::spu_model
