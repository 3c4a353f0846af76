#pragma once
// Undefined bits of registers: those that come from registers or bytes of the local store that nobody has written. They are followed until
// they have an effect: an address, a branch, a halt or a channel depends on them.
//
// A bit of a result is undefined if it changes when undefined bits of the operands change. To find out, the instruction is computed again
// with other values in their place (a trial). So all instructions are treated alike: masks, shuffles, selects and counts of shifts act on
// undefined bits as they do on the SPU. Instructions that move bits or add whole lanes need no trials. Whatever is reported does depend on
// undefined bits. A dependence may be missed if few values make a difference, as in a comparison for equality.

#include <array>
#include <optional>

#include "instruction_set.h"
#include "softcell/ls_sim/engine.h"
#include "spu_state.h"

namespace softcell::ls_sim::interpreter {

/// Follows undefined bits through one run. An observer of the run loop asks it in the SPU's floating-point mode.
class UndefinedValues {
 public:
  explicit UndefinedValues(EntryState entry);

  /// The next instruction, before it does anything. @return  the undefined value on which it depends, if any does
  std::optional<UndefinedUse> on_instruction(const Operation& op, std::uint32_t pc, const SpuState& state);
  /// The load that was the last instruction. @param undefined  of the quadword there
  void on_load(std::uint32_t lsa, const UndefinedBits& undefined);
  /// What the store that was the last instruction stores.
  UndefinedBits stored() const;

 private:
  void follow(const Operation& op, const InstructionInfo& info, const SpuState& state);
  std::optional<Quadword> undefined_without_trials(const Operation& op, const InstructionInfo& info,
                                                   const SpuState& state);
  std::optional<UndefinedUse> use_of(std::uint8_t reg, std::uint32_t bits, const SpuState& state,
                                     UndefinedUse::Kind kind);
  std::optional<UndefinedUse> use(const Operation& op, const InstructionInfo& info, const SpuState& state);

  /// Set where a register's bit is undefined.
  std::array<Quadword, kSpuRegisters> undefined_{};
  std::array<std::optional<LoadedFrom>, kSpuRegisters> from_{};  ///< none: a register that was never written
  SpuState trial_;                                               ///< in which instructions are computed again
  std::uint8_t target_ = 0;                                      ///< of the last instruction
  std::uint32_t pc_ = 0;
};

}  // namespace softcell::ls_sim::interpreter
