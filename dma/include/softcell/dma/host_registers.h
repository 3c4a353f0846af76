#pragma once
// Loads and stores of a host program to addresses that are registers: of an SPE's problem state, for example.

#include <cstdint>

namespace softcell::dma {

enum class HostAccess : std::uint8_t {
  kLoad,
  kStore,
  kUnknown  ///< by an instruction that is none of those below; it cannot be done
};

/// Does what a load or store of 4 bytes at such an address does. Called by the thread whose instruction it is, in
/// place of that instruction.
/// @param value  what is stored; of a load, receives what is read.
/// @return  false: there is no such register, and the thread gets its SIGSEGV.
using HostRegisterAccess = bool(std::uint64_t address, HostAccess access, std::uint32_t& value);

/// Sets who is asked when a thread accesses inaccessible memory by an ordinary load or store of 4 bytes: `mov`, or `add`, `or`, `and`, `sub`,
/// `xor`, `cmp` and `test` that read it as an operand; null: nobody. For the storage of host programs, which installs the handler of
/// SIGSEGV. Any thread.
void set_host_register_access(HostRegisterAccess* access);

}  // namespace softcell::dma
