#pragma once
// The loads and stores that compilers make for a volatile variable of 4 bytes.

#include <ucontext.h>

#include <cstdint>
#include <optional>

namespace softcell::dma {

/// mov between memory and a register, or of a constant to memory.
struct MovOfFourBytes {
  bool is_store = false;
  int gpr = 0;                             ///< 0..15 as instructions number them
  std::optional<std::uint32_t> immediate;  ///< stored in place of the register
  int bytes = 0;                           ///< of the instruction
};

/// @return  nothing for all other instructions.
std::optional<MovOfFourBytes> decode_mov(const std::uint8_t* code);

/// In the handler of SIGSEGV: does the instruction that has failed, if it accesses a register of a host program.
/// @return  whether the thread goes on behind it.
bool access_host_register(std::uint64_t address, mcontext_t& machine);

}  // namespace softcell::dma
