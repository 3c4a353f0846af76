#pragma once

// The table of the 199 instructions: bits, meaning, and the evidence that the meaning rests on.
// instructions.def has one row for each.

#include <cstdint>
#include <span>
#include <string_view>

#include "spu_model/machine.h"

namespace softcell::spu_model {

/// Where the fields of an instruction lie. [SPU-ISA, 2.3] documented
enum class Format { kRRR, kRR, kRI7, kRI8, kRI10, kRI16, kRI18, kHintRegister, kHintImmediate };

/// What the definition of an instruction rests on.
enum class Evidence {
  kArchitecture,  // the text of the architecture
  kTwoSources,    // two independent sources that agree
  kOneSource,     // one source, which names hardware as its own
  kAssumed,       // what is most likely; nothing says so
};

/// The operands of one instruction, as they were before it.
struct Operands {
  std::uint32_t word = 0;  // the instruction
  std::uint32_t pc = 0;
  Quadword ra, rb, rc;
  Quadword rt;  // the target, which some instructions read

  /// Bits first..last of the instruction, 0 the leftmost.
  std::uint32_t bits(int first, int last) const { return word << first >> (first + 31 - last); }
  std::int64_t signed_bits(int first, int last) const {
    return sign_extended(bits(first, last), last - first + 1);
  }
  std::uint32_t i7() const { return bits(11, 17); }
  int i8() const { return static_cast<int>(bits(10, 17)); }
  std::int64_t i10() const { return signed_bits(8, 17); }
  std::int64_t i16() const { return signed_bits(9, 24); }
  std::uint32_t i18() const { return bits(7, 24); }
};

using Value = Quadword (*)(const Operands&);                        // RT, from the operands alone
using FloatValue = Quadword (*)(const Operands&, Quadword& fpscr);  // RT, by FPSCR and with its flags
using Action = StepResult (*)(Machine&, const Operands&);  // anything else; PC is the next one already

struct Instruction {
  std::string_view mnemonic;
  Format format;
  std::string_view opcode;  // bits from the left, as text: "00011000000"
  Value value = nullptr;    // one of these three
  FloatValue float_value = nullptr;
  Action action = nullptr;
  Evidence evidence = Evidence::kAssumed;
  std::string_view note;  // what rests on less than `evidence`, empty if nothing

  Instruction(std::string_view name, Format f, std::string_view bits, Value v, Evidence e, std::string_view n)
      : mnemonic(name), format(f), opcode(bits), value(v), evidence(e), note(n) {}
  Instruction(std::string_view name, Format f, std::string_view bits, FloatValue v, Evidence e,
              std::string_view n)
      : mnemonic(name), format(f), opcode(bits), float_value(v), evidence(e), note(n) {}
  Instruction(std::string_view name, Format f, std::string_view bits, Action a, Evidence e,
              std::string_view n)
      : mnemonic(name), format(f), opcode(bits), action(a), evidence(e), note(n) {}

  /// The opcode at the left of a word, zeros elsewhere.
  std::uint32_t pattern() const;
  std::uint32_t mask() const;
};

/// All 199, in the order of the architecture's chapters.
std::span<const Instruction> instructions();
/// The instruction that `word` is, or null.
const Instruction* decode(std::uint32_t word);
/// The instruction of this name. @pre there is one.
const Instruction& instruction(std::string_view mnemonic);
/// Whether only a PowerXCell 8i has it.
bool is_enhanced_double(const Instruction& instruction);

}  // namespace softcell::spu_model
