#pragma once

// [SPU-ISA, 10] Control instructions, [SPU-ISA, 11] channel instructions.

#include "spu_model/instruction.h"

namespace softcell::spu_model::chapter {

constexpr std::uint32_t kStoppedWithDependencies = 0x3FFF;  // what stopd signals [SPU-ISA, 10] documented

inline StepResult stop(Machine&, const Operands& o) { return {Outcome::kStop, o.bits(18, 31)}; }
inline StepResult stopd(Machine&, const Operands&) { return {Outcome::kStop, kStoppedWithDependencies}; }

/// No special-purpose register is known: they read as zero.
inline Quadword mfspr(const Operands&) { return {}; }

inline StepResult of(ChannelAnswer answer) {
  switch (answer) {
    case ChannelAnswer::kDone:
      return {};
    case ChannelAnswer::kStalls:
      return {Outcome::kChannelStall};
    case ChannelAnswer::kInvalid:
      break;
  }
  return {Outcome::kInvalidChannel};
}
/// The answer's word goes into the preferred slot of RT.
inline StepResult receive(Machine& m, const Operands& o, ChannelAnswer answer, std::uint32_t word) {
  if (answer == ChannelAnswer::kDone) m.registers.at(o.bits(25, 31)) = preferred_word(word);
  return of(answer);
}
inline StepResult rdch(Machine& m, const Operands& o) {
  if (m.channels == nullptr) return {Outcome::kInvalidChannel};
  std::uint32_t word = 0;
  const ChannelAnswer answer = m.channels->read(o.bits(18, 24), word);
  return receive(m, o, answer, word);
}
inline StepResult rchcnt(Machine& m, const Operands& o) {
  if (m.channels == nullptr) return {Outcome::kInvalidChannel};
  std::uint32_t word = 0;
  const ChannelAnswer answer = m.channels->count(o.bits(18, 24), word);
  return receive(m, o, answer, word);
}
inline StepResult wrch(Machine& m, const Operands& o) {
  if (m.channels == nullptr) return {Outcome::kInvalidChannel};
  return of(m.channels->write(o.bits(18, 24), o.rt.word(0)));
}

}  // namespace softcell::spu_model::chapter
