#pragma once

// [SPU-ISA, 3] Memory - load/store instructions, and the generators of controls for insertion.

#include "spu_model/instruction.h"

namespace softcell::spu_model::chapter {

inline StepResult load(Machine& m, const Operands& o, std::int64_t address) {
  m.registers.at(o.bits(25, 31)) = m.load(static_cast<std::uint32_t>(address));
  return {};
}
inline StepResult store(Machine& m, const Operands& o, std::int64_t address) {
  m.store(static_cast<std::uint32_t>(address), o.rt);
  return {};
}
// Where each form of address points to. The low four bits and those beyond the local store fall away in the
// access.
inline std::int64_t d_form(const Operands& o) { return std::int64_t{o.ra.word(0)} + o.i10() * 16; }
inline std::int64_t x_form(const Operands& o) { return std::int64_t{o.ra.word(0)} + o.rb.word(0); }
inline std::int64_t a_form(const Operands& o) { return o.i16() * 4; }
inline std::int64_t r_form(const Operands& o) { return std::int64_t{o.pc} + o.i16() * 4; }

inline StepResult lqd(Machine& m, const Operands& o) { return load(m, o, d_form(o)); }
inline StepResult lqx(Machine& m, const Operands& o) { return load(m, o, x_form(o)); }
inline StepResult lqa(Machine& m, const Operands& o) { return load(m, o, a_form(o)); }
inline StepResult lqr(Machine& m, const Operands& o) { return load(m, o, r_form(o)); }
inline StepResult stqd(Machine& m, const Operands& o) { return store(m, o, d_form(o)); }
inline StepResult stqx(Machine& m, const Operands& o) { return store(m, o, x_form(o)); }
inline StepResult stqa(Machine& m, const Operands& o) { return store(m, o, a_form(o)); }
inline StepResult stqr(Machine& m, const Operands& o) { return store(m, o, r_form(o)); }

/// The control for shufb that puts the `size` bytes of a preferred slot, which begin at byte `slot`, to where
/// `address` points to within a quadword, and leaves the second operand's other bytes.
inline Quadword insertion_control(std::uint32_t address, int size, int slot) {
  const int place = static_cast<int>(address & 15) / size * size;
  return each_byte([&](int i) { return i >= place && i < place + size ? slot + i - place : 16 + i; });
}
inline std::uint32_t control_address_d(const Operands& o) { return o.ra.word(0) + o.i7(); }
inline std::uint32_t control_address_x(const Operands& o) { return o.ra.word(0) + o.rb.word(0); }

inline Quadword cbd(const Operands& o) { return insertion_control(control_address_d(o), 1, 3); }
inline Quadword chd(const Operands& o) { return insertion_control(control_address_d(o), 2, 2); }
inline Quadword cwd(const Operands& o) { return insertion_control(control_address_d(o), 4, 0); }
inline Quadword cdd(const Operands& o) { return insertion_control(control_address_d(o), 8, 0); }
inline Quadword cbx(const Operands& o) { return insertion_control(control_address_x(o), 1, 3); }
inline Quadword chx(const Operands& o) { return insertion_control(control_address_x(o), 2, 2); }
inline Quadword cwx(const Operands& o) { return insertion_control(control_address_x(o), 4, 0); }
inline Quadword cdx(const Operands& o) { return insertion_control(control_address_x(o), 8, 0); }

}  // namespace softcell::spu_model::chapter
