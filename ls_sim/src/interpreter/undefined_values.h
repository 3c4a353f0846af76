#pragma once
// Which bits of the registers come from nowhere: from registers or from bytes of the local store that nobody has
// written. They are followed to where they matter.
//
// A bit of a result is undefined if it changes when the undefined bits among the operands do: the instruction is computed
// again with others in their place. So all instructions are treated alike, and an `and` with a mask, a shuffle, a select
// or a count of shifts makes of undefined bits what it makes of them on the SPU. Where an instruction moves bits or adds
// whole lanes, that is known without. What is reported does depend on them; of a comparison that tells few values apart
// something may be missed.

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
