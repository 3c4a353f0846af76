#pragma once
// Says which rule an instruction broke that the host's processor could not execute.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "kernel_context.h"
#include "softcell/dma/fault.h"

namespace softcell::ls_sim::native {

// The local store is given by its first byte.

/// Where the kernel has called an address outside of the local store, which lies on the stack as the address to return to.
/// @return  the last byte of the call, a local-store address; nothing: it has not called such an address
std::optional<std::uint32_t> call_outside(const Trap& trap, const std::byte* local_store);

/// "the instruction at local-store address 0x00420". @param call  as call_outside() returns it
std::string place_of(const Trap& trap, const std::byte* local_store, std::optional<std::uint32_t> call);

/// The fault of an instruction that is invalid, divides by zero, or accesses memory that it may not.
/// @param place              as place_of() returns it
/// @param main_memory_bytes  the size of main memory, whose addresses are no pointers
dma::Fault fault_of_instruction(const Trap& trap, const std::byte* local_store, const std::string& place,
                                std::uint64_t main_memory_bytes);

}  // namespace softcell::ls_sim::native
