#pragma once

// Operands for tests: corners and random ones, by what an instruction does with them.

#include <random>

#include "spu_model/encode.h"

namespace softcell::spu_model {

using Random = std::mt19937_64;

/// What a register's contents are chosen as.
enum class Kind { kIntegers, kSingles, kDoubles };

/// The kind of an instruction by what it reads.
Kind kind_of(const Instruction& instruction);
bool is_floating_point(const Instruction& instruction);

/// A quadword of corner values, of random ones, or of both, element by element.
Quadword random_quadword(Kind kind, Random& random);
/// One of the values at which a word or a doubleword of that kind changes its meaning; integers of 32 bits.
std::uint64_t corner(Kind kind, Random& random);
std::size_t corners(Kind kind);
std::uint64_t corner_number(Kind kind, std::size_t i);

/// The instruction with registers from a few, so that they are often the same, and an immediate that is often
/// at one of its ends; bits that the format leaves free are random.
std::uint32_t random_word(const Instruction& instruction, Random& random);

/// Whether the architecture leaves open what the word does: an indirect branch that both disables and enables
/// interrupts.
bool is_undefined(std::uint32_t word);

}  // namespace softcell::spu_model
