#pragma once

// [SPU-ISA, 7] Compare, branch and halt instructions, [SPU-ISA, 8] hints for branches.

#include "spu_model/instruction.h"

namespace softcell::spu_model::chapter {

constexpr std::uint64_t mask_if(bool condition) { return condition ? ~0ull : 0; }

inline Quadword ceqb(const Operands& o) {
  return each_byte([&](int i) { return mask_if(o.ra.byte(i) == o.rb.byte(i)); });
}
inline Quadword ceqbi(const Operands& o) {
  return each_byte([&](int i) { return mask_if(o.ra.byte(i) == (o.i10() & 0xFF)); });
}
inline Quadword ceqh(const Operands& o) {
  return each_half([&](int i) { return mask_if(o.ra.half(i) == o.rb.half(i)); });
}
inline Quadword ceqhi(const Operands& o) {
  return each_half([&](int i) { return mask_if(s16(o.ra.half(i)) == o.i10()); });
}
inline Quadword ceq(const Operands& o) {
  return each_word([&](int i) { return mask_if(o.ra.word(i) == o.rb.word(i)); });
}
inline Quadword ceqi(const Operands& o) {
  return each_word([&](int i) { return mask_if(s32(o.ra.word(i)) == o.i10()); });
}
inline Quadword cgtb(const Operands& o) {
  return each_byte([&](int i) { return mask_if(s8(o.ra.byte(i)) > s8(o.rb.byte(i))); });
}
inline Quadword cgtbi(const Operands& o) {
  return each_byte([&](int i) { return mask_if(s8(o.ra.byte(i)) > s8(o.bits(10, 17))); });
}
inline Quadword cgth(const Operands& o) {
  return each_half([&](int i) { return mask_if(s16(o.ra.half(i)) > s16(o.rb.half(i))); });
}
inline Quadword cgthi(const Operands& o) {
  return each_half([&](int i) { return mask_if(s16(o.ra.half(i)) > o.i10()); });
}
inline Quadword cgt(const Operands& o) {
  return each_word([&](int i) { return mask_if(s32(o.ra.word(i)) > s32(o.rb.word(i))); });
}
inline Quadword cgti(const Operands& o) {
  return each_word([&](int i) { return mask_if(s32(o.ra.word(i)) > o.i10()); });
}
inline Quadword clgtb(const Operands& o) {
  return each_byte([&](int i) { return mask_if(o.ra.byte(i) > o.rb.byte(i)); });
}
inline Quadword clgtbi(const Operands& o) {
  return each_byte([&](int i) { return mask_if(o.ra.byte(i) > o.bits(10, 17)); });
}
inline Quadword clgth(const Operands& o) {
  return each_half([&](int i) { return mask_if(o.ra.half(i) > o.rb.half(i)); });
}
inline Quadword clgthi(const Operands& o) {
  return each_half([&](int i) { return mask_if(o.ra.half(i) > (o.i10() & 0xFFFF)); });
}
inline Quadword clgt(const Operands& o) {
  return each_word([&](int i) { return mask_if(o.ra.word(i) > o.rb.word(i)); });
}
inline Quadword clgti(const Operands& o) {
  return each_word([&](int i) { return mask_if(o.ra.word(i) > (o.i10() & 0xFFFFFFFF)); });
}

inline StepResult halt_if(bool condition) { return {condition ? Outcome::kHalt : Outcome::kNext}; }

inline StepResult heq(Machine&, const Operands& o) { return halt_if(o.ra.word(0) == o.rb.word(0)); }
inline StepResult heqi(Machine&, const Operands& o) { return halt_if(s32(o.ra.word(0)) == o.i10()); }
inline StepResult hgt(Machine&, const Operands& o) { return halt_if(s32(o.ra.word(0)) > s32(o.rb.word(0))); }
inline StepResult hgti(Machine&, const Operands& o) { return halt_if(s32(o.ra.word(0)) > o.i10()); }
inline StepResult hlgt(Machine&, const Operands& o) { return halt_if(o.ra.word(0) > o.rb.word(0)); }
inline StepResult hlgti(Machine&, const Operands& o) {
  return halt_if(o.ra.word(0) > (o.i10() & 0xFFFFFFFF));
}

inline StepResult go_to(Machine& m, std::int64_t address) {
  m.pc = static_cast<std::uint32_t>(address) & kLocalStoreLimit & ~3u;
  return {};
}
inline StepResult go_to_if(bool condition, Machine& m, std::int64_t address) {
  return condition ? go_to(m, address) : StepResult{};
}
/// The address behind the branch goes into the preferred word of RT.
inline void link(Machine& m, const Operands& o) {
  m.registers.at(o.bits(25, 31)) = preferred_word((o.pc + 4) & kLocalStoreLimit);
}
/// An indirect branch that is taken: bit 12 disables interrupts, bit 13 enables them. (Both: undefined; here,
/// none.)
inline StepResult go_indirectly(Machine& m, const Operands& o, std::uint32_t address) {
  const bool disable = o.bits(12, 12) != 0;
  const bool enable = o.bits(13, 13) != 0;
  if (disable != enable) m.interrupts_enabled = enable;
  return go_to(m, address);
}

inline std::int64_t relative(const Operands& o) { return std::int64_t{o.pc} + o.i16() * 4; }
inline std::int64_t absolute(const Operands& o) { return o.i16() * 4; }

inline StepResult br(Machine& m, const Operands& o) { return go_to(m, relative(o)); }
inline StepResult bra(Machine& m, const Operands& o) { return go_to(m, absolute(o)); }
inline StepResult brsl(Machine& m, const Operands& o) {
  link(m, o);
  return go_to(m, relative(o));
}
inline StepResult brasl(Machine& m, const Operands& o) {
  link(m, o);
  return go_to(m, absolute(o));
}
inline StepResult bi(Machine& m, const Operands& o) { return go_indirectly(m, o, o.ra.word(0)); }
inline StepResult bisl(Machine& m, const Operands& o) {
  link(m, o);
  return go_indirectly(m, o, o.ra.word(0));
}
inline StepResult iret(Machine& m, const Operands& o) { return go_indirectly(m, o, m.srr0); }
inline StepResult bisled(Machine& m, const Operands& o) {
  link(m, o);
  const bool event = m.channels != nullptr && m.channels->event_count() != 0;
  return event ? go_indirectly(m, o, o.ra.word(0)) : StepResult{};
}
inline StepResult brnz(Machine& m, const Operands& o) { return go_to_if(o.rt.word(0) != 0, m, relative(o)); }
inline StepResult brz(Machine& m, const Operands& o) { return go_to_if(o.rt.word(0) == 0, m, relative(o)); }
inline StepResult brhnz(Machine& m, const Operands& o) { return go_to_if(o.rt.half(1) != 0, m, relative(o)); }
inline StepResult brhz(Machine& m, const Operands& o) { return go_to_if(o.rt.half(1) == 0, m, relative(o)); }
inline StepResult go_indirectly_if(bool condition, Machine& m, const Operands& o) {
  return condition ? go_indirectly(m, o, o.ra.word(0)) : StepResult{};
}
inline StepResult biz(Machine& m, const Operands& o) { return go_indirectly_if(o.rt.word(0) == 0, m, o); }
inline StepResult binz(Machine& m, const Operands& o) { return go_indirectly_if(o.rt.word(0) != 0, m, o); }
inline StepResult bihz(Machine& m, const Operands& o) { return go_indirectly_if(o.rt.half(1) == 0, m, o); }
inline StepResult bihnz(Machine& m, const Operands& o) { return go_indirectly_if(o.rt.half(1) != 0, m, o); }

/// Hints and their like change nothing that a program can see.
inline StepResult no_operation(Machine&, const Operands&) { return {}; }

}  // namespace softcell::spu_model::chapter
