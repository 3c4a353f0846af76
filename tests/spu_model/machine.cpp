#include "spu_model/machine.h"

#include "spu_model/instruction.h"

namespace softcell::spu_model {

Quadword Machine::load(std::uint32_t address) const {
  const std::uint32_t first = address & kLocalStoreLimit & ~15u;
  return each_byte([&](int i) { return local_store.at(first + static_cast<std::uint32_t>(i)); });
}

void Machine::store(std::uint32_t address, const Quadword& value) {
  const std::uint32_t first = address & kLocalStoreLimit & ~15u;
  for (int i = 0; i < 16; ++i) local_store.at(first + static_cast<std::uint32_t>(i)) = value.byte(i);
}

std::uint32_t Machine::fetch(std::uint32_t address) const {
  return load(address).word(static_cast<int>(address / 4 % 4));
}

void Machine::place(std::uint32_t address, std::uint32_t instruction) {
  Quadword quadword = load(address);
  quadword.set_word(static_cast<int>(address / 4 % 4), instruction);
  store(address, quadword);
}

StepResult execute(Machine& machine, std::uint32_t word) {
  const Instruction* const row = decode(word);
  if (row == nullptr || (is_enhanced_double(*row) && !machine.enhanced_double)) {
    return {Outcome::kInvalidInstruction};
  }
  Operands operands;
  operands.word = word;
  operands.pc = machine.pc;
  // RRR has its target at the left and its third source where the others have their target.
  const std::uint32_t rt = row->format == Format::kRRR ? operands.bits(4, 10) : operands.bits(25, 31);
  operands.ra = machine.registers.at(operands.bits(18, 24));
  operands.rb = machine.registers.at(operands.bits(11, 17));
  operands.rc = machine.registers.at(operands.bits(25, 31));
  operands.rt = machine.registers.at(rt);

  const std::uint32_t this_pc = machine.pc;
  machine.pc = (this_pc + 4) & kLocalStoreLimit;
  StepResult result;
  if (row->value != nullptr) machine.registers.at(rt) = row->value(operands);
  if (row->float_value != nullptr) machine.registers.at(rt) = row->float_value(operands, machine.fpscr);
  if (row->action != nullptr) result = row->action(machine, operands);
  if (result.outcome == Outcome::kInvalidChannel || result.outcome == Outcome::kChannelStall) {
    machine.pc = this_pc;
  }
  return result;
}

StepResult step(Machine& machine) {
  if (machine.interrupts_enabled && machine.channels != nullptr && machine.channels->event_count() != 0) {
    machine.interrupts_enabled = false;
    machine.srr0 = machine.pc;
    machine.pc = 0;
  }
  return execute(machine, machine.fetch(machine.pc));
}

}  // namespace softcell::spu_model
