#pragma once
// Instruction words for tests, and programs made of them.

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "interpreter/instruction_set.h"
#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim::interpreter {

inline std::uint32_t opcode(Mnemonic mnemonic) {
  const InstructionInfo& info = info_of(mnemonic);
  return std::uint32_t{info.opcode} << (32 - info.opcode_bits);
}
inline std::uint32_t rr(Mnemonic mnemonic, std::uint32_t rt, std::uint32_t ra, std::uint32_t rb = 0) {
  return opcode(mnemonic) | rb << 14 | ra << 7 | rt;
}
inline std::uint32_t ri10(Mnemonic mnemonic, std::uint32_t rt, std::uint32_t ra, std::int32_t imm) {
  return opcode(mnemonic) | (static_cast<std::uint32_t>(imm) & 0x3FF) << 14 | ra << 7 | rt;
}
inline std::uint32_t ri7(Mnemonic mnemonic, std::uint32_t rt, std::uint32_t ra, std::int32_t imm) {
  return rr(mnemonic, rt, ra, static_cast<std::uint32_t>(imm) & 0x7F);
}
inline std::uint32_t ri8(Mnemonic mnemonic, std::uint32_t rt, std::uint32_t ra, std::uint32_t imm) {
  return opcode(mnemonic) | imm << 14 | ra << 7 | rt;
}
inline std::uint32_t ri16(Mnemonic mnemonic, std::uint32_t rt, std::int32_t imm) {
  return opcode(mnemonic) | (static_cast<std::uint32_t>(imm) & 0xFFFF) << 7 | rt;
}
inline std::uint32_t ri18(Mnemonic mnemonic, std::uint32_t rt, std::uint32_t imm) {
  return opcode(mnemonic) | imm << 7 | rt;
}
inline std::uint32_t rrr(Mnemonic mnemonic, std::uint32_t rt, std::uint32_t ra, std::uint32_t rb,
                         std::uint32_t rc) {
  return opcode(mnemonic) | rt << 21 | rb << 14 | ra << 7 | rc;
}
inline std::uint32_t stop_with(std::uint32_t code) { return code; }

/// Copies the quadword with `stop 0x2005` over the one that it then runs into, which has `stop 0x2001`.
/// @param between  is executed between the store and what was stored: a sync, or another word
inline std::vector<std::uint32_t> overwrites_its_code(std::uint32_t between) {
  using enum Mnemonic;
  constexpr std::uint32_t kNop = 0x40200000;
  return {
      ri16(lqa, 3, 0xA0 / 4),
      ri16(stqa, 3, 0x90 / 4),
      between,
      kNop,  // 0x80
      stop_with(0x2001),
      kNop,
      kNop,
      kNop,  // 0x90
      stop_with(0x2005),
      kNop,
      kNop,
      kNop,  // 0xA0
  };
}

/// A program that begins and lies at `begin`, without variables.
inline KernelImage program_of(const std::vector<std::uint32_t>& words, std::uint32_t begin = 0x80) {
  KernelImage image;
  image.name = "test";
  image.machine = Machine::kSpu;
  image.begin = image.entry = image.text_begin = begin;
  for (const std::uint32_t word : words) {
    for (int shift = 24; shift >= 0; shift -= 8) image.bytes.push_back(static_cast<std::byte>(word >> shift));
  }
  const auto end = begin + static_cast<std::uint32_t>(image.bytes.size());
  image.text_end = image.rodata_begin = image.rodata_end = image.data_begin = image.data_end = end;
  image.sizes.text = end - begin;
  image.sizes.end = (end + 15) / 16 * 16;
  image.sizes.stack = dma::kLocalStoreBytes - image.sizes.end;
  image.sizes.budget = dma::kLocalStoreBytes;
  return image;
}

}  // namespace softcell::ls_sim::interpreter
