#pragma once
// What an SPU holds besides its local store and its channels.

#include <cstdint>

#include "fpscr.h"
#include "instruction_set.h"
#include "quadword.h"
#include "softcell/ls_sim/debugger.h"

namespace softcell::ls_sim::interpreter {

/// Registers are Quadwords: quadword.h says in which order their bytes lie. word(registers[n], 0) is the
/// preferred slot of register n; load_quadword() and store_quadword() change between a register and 16 bytes
/// in the SPU's order.
struct SpuState {
  alignas(64) Quadword registers[kSpuRegisters] = {};
  std::uint32_t pc = 0;    ///< local-store address of the next instruction; a multiple of 4
  std::uint32_t srr0 = 0;  ///< where iret returns to
  bool interrupts_enabled = false;
  /// The SPE is one of a PowerXCell 8i, which has the compares of doubles. On a PS3 they are no instructions.
  bool has_enhanced_double = false;
  Fpscr fpscr;
};

/// Why execution went on or ended.
enum class Ending : std::uint8_t {
  kNone,          ///< it goes on
  kStop,          ///< stop or stopd, with the stop code
  kHalt,          ///< a halt-on-condition found its condition true
  kInvalid,       ///< the word is no instruction
  kChannelFault,  ///< a channel operation broke a rule
  kInterrupted,   ///< somebody asked for the end
};

}  // namespace softcell::ls_sim::interpreter
