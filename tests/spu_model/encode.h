#pragma once

// Instruction words of the model's table, for tests.

#include <string_view>

#include "spu_model/instruction.h"

namespace softcell::spu_model {

/// The registers and the immediate of an instruction; a format takes what it has.
struct Fields {
  std::uint32_t rt = 0, ra = 0, rb = 0, rc = 0;
  std::int64_t immediate = 0;  // its low bits are taken
};

constexpr int immediate_bits(Format format) {
  switch (format) {
    case Format::kRI7:
      return 7;
    case Format::kRI8:
      return 8;
    case Format::kRI10:
      return 10;
    case Format::kRI16:
    case Format::kHintImmediate:
      return 16;
    case Format::kRI18:
      return 18;
    case Format::kRRR:
    case Format::kRR:
    case Format::kHintRegister:
      break;
  }
  return 0;
}

inline std::uint32_t encode(const Instruction& row, const Fields& f) {
  const int bits = immediate_bits(row.format);
  const std::uint32_t immediate = static_cast<std::uint32_t>(f.immediate) & ((1u << bits) - 1);
  const std::uint32_t ra = (f.ra & 127) << 7;
  const std::uint32_t rt = f.rt & 127;
  switch (row.format) {
    case Format::kRRR:
      return row.pattern() | rt << 21 | (f.rb & 127) << 14 | ra | (f.rc & 127);
    case Format::kRR:
      return row.pattern() | (f.rb & 127) << 14 | ra | rt;
    case Format::kRI7:
    case Format::kRI8:
    case Format::kRI10:
      return row.pattern() | immediate << 14 | ra | rt;
    case Format::kRI16:
    case Format::kRI18:
    case Format::kHintImmediate:
      return row.pattern() | immediate << 7 | rt;
    case Format::kHintRegister:
      break;
  }
  return row.pattern() | ra | rt;
}
inline std::uint32_t encode(std::string_view mnemonic, const Fields& fields) {
  return encode(instruction(mnemonic), fields);
}

}  // namespace softcell::spu_model
