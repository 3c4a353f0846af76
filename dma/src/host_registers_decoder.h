#pragma once
// The instructions that compilers make for a volatile variable of 4 bytes.

#include <ucontext.h>

#include <cstdint>
#include <optional>

namespace softcell::dma {

/// What an instruction does with the variable.
enum class RegisterUse : std::uint8_t {
  kStore,
  kLoad,
  kLoadSigned,
  kAdd,
  kOr,
  kAnd,
  kSubtract,
  kXor,
  kCompare,
  kTest
};

/// mov between memory and a register, or of a constant to memory; a load into the 64 bits of a register with its sign; and a load that is
/// an operand of an arithmetic instruction, whose other one is a register or a constant.
struct AccessOfFourBytes {
  RegisterUse use = RegisterUse::kLoad;
  int gpr = 0;                             ///< 0..15 as instructions number them
  std::optional<std::uint32_t> immediate;  ///< in place of the register
  bool memory_first = false;               ///< of a comparison: the variable is compared with the operand
  int bytes = 0;                           ///< of the instruction
};

/// @return  nothing for all other instructions, those among them that read a variable and write it.
std::optional<AccessOfFourBytes> decode_access(const std::uint8_t* code);

/// In the handler of SIGSEGV: does the instruction that has failed, if it accesses a register of a host program.
/// @return  whether the thread goes on behind it.
bool access_host_register(std::uint64_t address, mcontext_t& machine);

}  // namespace softcell::dma
