#include "instruction_set.h"

#include "softcell/base/assert.h"

namespace softcell::ls_sim::interpreter {
namespace {

constexpr unsigned kIndexBits = 11;  // of the longest opcode
constexpr std::size_t kIndexSize = std::size_t{1} << kIndexBits;

/// Maps the first eleven bits of a word to its instruction.
constexpr std::array<Mnemonic, kIndexSize> make_index() {
  std::array<Mnemonic, kIndexSize> index{};
  index.fill(Mnemonic::invalid);
  for (std::size_t row = 0; row < kInstructions; ++row) {
    const InstructionInfo& info = kInstructionTable[row];
    const unsigned free_bits = kIndexBits - info.opcode_bits;
    for (std::size_t low = 0; low < (std::size_t{1} << free_bits); ++low) {
      Mnemonic& entry = index[(std::size_t{info.opcode} << free_bits) + low];
      if (entry != Mnemonic::invalid) throw "two instructions share an opcode";  // ends the compilation
      entry = static_cast<Mnemonic>(row);
    }
  }
  return index;
}

constexpr auto kIndex = make_index();

constexpr std::uint8_t register_field(std::uint32_t word, unsigned last_bit) {
  return static_cast<std::uint8_t>((word >> (31 - last_bit)) & 0x7F);
}

/// `bits` bits that end at `last_bit`, as a signed number.
constexpr std::int32_t signed_field(std::uint32_t word, unsigned last_bit, unsigned bits) {
  const unsigned first_bit = last_bit + 1 - bits;
  return static_cast<std::int32_t>(word << first_bit) >> (32 - bits);
}

constexpr std::int32_t unsigned_field(std::uint32_t word, unsigned last_bit, unsigned bits) {
  return static_cast<std::int32_t>((word >> (31 - last_bit)) & ((1u << bits) - 1));
}

constexpr std::int32_t immediate(std::uint32_t word, Mnemonic mnemonic) {
  constexpr unsigned kStopCodeBits = 14;
  if (mnemonic == Mnemonic::stop) return unsigned_field(word, 31, kStopCodeBits);
  switch (info_of(mnemonic).format) {
    case Format::kRi7:
      return signed_field(word, 17, 7);
    case Format::kRi8:
      return unsigned_field(word, 17, 8);
    case Format::kRi10:
      return signed_field(word, 17, 10);
    case Format::kRi16:
    case Format::kRi16h:
      return signed_field(word, 24, 16);
    case Format::kRi18:
      return unsigned_field(word, 24, 18);
    default:
      return 0;
  }
}

}  // namespace

Operation decode(std::uint32_t word) {
  Operation operation{.word = word, .mnemonic = kIndex[word >> (32 - kIndexBits)]};
  if (operation.mnemonic == Mnemonic::invalid) return operation;
  const bool is_rrr = info_of(operation.mnemonic).format == Format::kRrr;
  operation.imm = immediate(word, operation.mnemonic);
  operation.rt = register_field(word, is_rrr ? 10 : 31);
  operation.rb = register_field(word, 17);
  operation.ra = register_field(word, 24);
  operation.rc = register_field(word, 31);
  return operation;
}

std::int32_t hint_distance(const Operation& operation) {
  const Format format = info_of(operation.mnemonic).format;
  SC_ASSERT(format == Format::kRi16h || format == Format::kRrh, "the word {} is no hint", operation.word);
  const std::uint32_t high = operation.word >> (format == Format::kRrh ? 14 : 23) & 3;
  const std::uint32_t distance = high << 7 | (operation.word & 0x7F);
  return static_cast<std::int32_t>(distance << 23) >> 23;
}

}  // namespace softcell::ls_sim::interpreter
