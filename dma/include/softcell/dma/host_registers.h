#pragma once
// Loads and stores of a host program to addresses that are registers, for example of an SPE's problem state.

#include <cstdint>

namespace softcell::dma {

enum class HostAccess : std::uint8_t {
  kLoad,
  kStore,
  kUnknown  ///< by an instruction that is not one of those below; it cannot be executed
};

/// Executes a load or store of 4 bytes at such an address. Called by the thread that executes the instruction, instead of the instruction.
/// @param value  the value to store; for a load, receives the value that is read.
/// @return  false: there is no such register, and the thread gets its SIGSEGV.
using HostRegisterAccess = bool(std::uint64_t address, HostAccess access, std::uint32_t& value);

/// Sets the function that is called when a thread accesses inaccessible memory by an ordinary load or store of 4 bytes: `mov`, or `add`,
/// `or`, `and`, `sub`, `xor`, `cmp` and `test` with a memory operand; null: none. For the storage of host programs, which installs the
/// handler of SIGSEGV. Any thread.
void set_host_register_access(HostRegisterAccess* access);

}  // namespace softcell::dma
