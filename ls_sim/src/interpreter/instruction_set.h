#pragma once
// The SPU's instruction set as a table (instructions.def), and the decoder made from it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"

namespace softcell::ls_sim::interpreter {

/// Local-store addresses wrap around at 256 KB; instructions lie at multiples of 4. [SPU-ISA] documented
inline constexpr std::uint32_t kInstructionMask = dma::kLocalStoreMask & ~3u;
inline constexpr std::uint32_t kQuadwordMask = dma::kLocalStoreMask & ~15u;

/// Where a word holds its fields, bit 0 being the most significant. [SPU-ISA, instruction formats] documented
///   Rrr    op 0..3   RT 4..10   RB 11..17  RA 18..24  RC 25..31
///   Rr     op 0..10  RB 11..17  RA 18..24  RT 25..31
///   Ri7    op 0..10  I7 11..17  RA 18..24  RT 25..31
///   Ri8    op 0..9   I8 10..17  RA 18..24  RT 25..31
///   Ri10   op 0..7   I10 8..17  RA 18..24  RT 25..31
///   Ri16   op 0..8   I16 9..24  RT 25..31
///   Ri18   op 0..6   I18 7..24  RT 25..31
///   Ri16h  op 0..6   ROH 7..8   I16 9..24  ROL 25..31
///   Rrh    op 0..10  P 11       ROH 16..17 RA 18..24  ROL 25..31
enum class Format : std::uint8_t { kRrr, kRr, kRi7, kRi8, kRi10, kRi16, kRi18, kRi16h, kRrh };

/// What determines an instruction's pipe and latency. [cell simulators' listings] second-hand
enum class LatencyClass : std::uint8_t {
  kFx2,   ///< even, 2 cycles: add, logic, compare, constants
  kFx3,   ///< even, 4: shifts and rotates of elements
  kFxb,   ///< even, 4: bytes
  kFp6,   ///< even, 6: single precision
  kFp7,   ///< even, 7: multiply, convert, interpolate
  kFpd,   ///< even, 13: double precision, which lets nothing issue for 6 cycles
  kNop,   ///< even
  kShuf,  ///< odd, 4: shuffles, shifts of the quadword
  kLs,    ///< odd, 6: loads and stores
  kBr,    ///< odd, 4: branches, stop, sync
  kSpr,   ///< odd, 6: channels and special registers
  kHb,    ///< odd, 15: branch hints
  kLnop,  ///< odd
};

/// True for the pipe that executes arithmetic, false for the one of loads, stores, shuffles and branches.
constexpr bool is_even_pipe(LatencyClass latency) { return latency <= LatencyClass::kNop; }

/// Bits of InstructionInfo::reads: the fields whose registers are read.
namespace reads {
inline constexpr std::uint8_t kNothing = 0, kA = 1, kB = 2, kC = 4, kT = 8;
inline constexpr std::uint8_t kAB = kA | kB, kABC = kA | kB | kC, kAT = kA | kT, kABT = kA | kB | kT;
}  // namespace reads

/// What an instruction touches besides registers; instructions.def explains each.
enum class Kind : std::uint8_t {
  kCompute,
  kEnhancedDouble,
  kFloat,
  kControlFloat,
  kLoad,
  kStore,
  kJump,
  kInterruptReturn,
  kEventJump,
  kHalt,
  kStop,
  kBreakpoint,
  kReadChannel,
  kCountChannel,
  kWriteChannel,
  kSync,
  kNothing
};

/// The instructions in the order of the table, and what is none of them.
enum class Mnemonic : std::uint8_t {
#define SC_SPU_INSTRUCTION(identifier, ...) identifier,
#include "instructions.def"
#undef SC_SPU_INSTRUCTION
  invalid
};

inline constexpr std::size_t kInstructions = static_cast<std::size_t>(Mnemonic::invalid);

struct InstructionInfo {
  std::string_view mnemonic;
  Format format;
  std::uint8_t opcode_bits;
  std::uint16_t opcode;
  LatencyClass latency;
  std::uint8_t reads;
  bool writes_target;
  Kind kind;
};

inline constexpr std::array<InstructionInfo, kInstructions> kInstructionTable{{
#define SC_SPU_INSTRUCTION(identifier, mnemonic, format, bits, opcode, latency, reads, writes, kind) \
  {mnemonic, Format::format, bits, opcode, LatencyClass::latency, reads, writes, Kind::k##kind},
#include "instructions.def"
#undef SC_SPU_INSTRUCTION
}};

/// @pre  the mnemonic is not `invalid`
constexpr const InstructionInfo& info_of(Mnemonic mnemonic) {
  SC_ASSERT(static_cast<std::size_t>(mnemonic) < kInstructionTable.size(), "mnemonic {} of {}", mnemonic,
            kInstructionTable.size());
  return kInstructionTable[static_cast<std::size_t>(mnemonic)];
}

/// A word with its fields taken apart. Of a field that the format lacks, the value is that of the same bits.
struct Operation {
  std::uint32_t word = 0;                 ///< as the SPU fetches it, most significant byte first
  std::int32_t imm = 0;                   ///< sign-extended, but for I8, I18 and the code of `stop`
  Mnemonic mnemonic = Mnemonic::invalid;  ///< `stop` for a word of zeros
  std::uint8_t rt = 0, ra = 0, rb = 0, rc = 0;
};

/// An indirect branch with one of these bits in its RB field changes the interrupt enable.
/// [SPU-ISA, branch instructions] documented
inline constexpr std::uint8_t kDisableInterrupts = 0x20, kEnableInterrupts = 0x10;
/// In RB of `sync`: also for channels. In RB of `hbr`: an inline prefetch.
inline constexpr std::uint8_t kFeatureBit = 0x40;

/// Any word. Reserved fields are ignored. Any thread.
Operation decode(std::uint32_t word);

/// The distance in words from a hint to its branch: 9 bits, signed. @pre  a Ri16h or Rrh format
std::int32_t hint_distance(const Operation& operation);

}  // namespace softcell::ls_sim::interpreter
