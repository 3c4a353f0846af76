#include "trap_fault.h"

#include <csignal>
#include <cstring>

#include "softcell/base/text.h"
#include "softcell/dma/addresses.h"
#include "softcell/ls_sim/local_store.h"

namespace softcell::ls_sim::native {
namespace {

std::uintptr_t begin_of(const std::byte* local_store) {
  return reinterpret_cast<std::uintptr_t>(local_store);
}

/// The fault of an access of memory that the kernel may not access. @param did  what it did: "... wrote to "
dma::Fault fault_of_access(std::uintptr_t address, std::uintptr_t local_store,
                           std::uint64_t main_memory_bytes, const std::string& did) {
  const auto fault = [&](const std::string& where, dma::Rule rule = dma::Rule::kOutsideLocalStore) {
    return dma::Fault{.rule = rule, .detail = did + where};
  };
  const std::uintptr_t offset = address - local_store;
  if (offset < 2 * std::uintptr_t{dma::kLocalStoreBytes})
    return fault(base::byte_count(offset - dma::kLocalStoreMask) + " past the end of the local store");
  if (local_store - address <= LocalStore::kGuardBytes)
    return fault(base::byte_count(local_store - address) + " before the local store");
  const std::string named = "address " + base::hex(address, 5);
  // After the addresses around the local store, which may be low words of addresses in a large main memory.
  if (dma::is_low_word_of_effective_address(address, main_memory_bytes))
    return fault(named + ", the low 32 bits of an effective address; main storage is reached by DMA only",
                 dma::Rule::kEffectiveAddressAsPointer);
  if (address < dma::kLocalStoreBytes)
    return fault(named +
                 ", which is no pointer in a kernel built for the host: its local store lies elsewhere");
  return fault(named + ", which is neither in the local store nor an effective address");
}

}  // namespace

std::optional<std::uint32_t> call_outside(const Trap& trap, const std::byte* local_store) {
  const std::uintptr_t top = trap.stack - begin_of(local_store);
  if (!trap.instruction_fetch || trap.instruction != trap.address ||
      top > dma::kLocalStoreBytes - sizeof(std::uint64_t))
    return std::nullopt;
  std::uint64_t back = 0;
  std::memcpy(&back, local_store + top, sizeof back);
  const std::uintptr_t call = back - 1 - begin_of(local_store);
  return call < dma::kLocalStoreBytes ? std::optional(static_cast<std::uint32_t>(call)) : std::nullopt;
}

std::string place_of(const Trap& trap, const std::byte* local_store, std::optional<std::uint32_t> call) {
  const std::uintptr_t at = trap.instruction - begin_of(local_store);
  if (at < dma::kLocalStoreBytes) return "the instruction at local-store address " + base::hex(at, 5);
  if (call) return "the call at local-store address " + base::hex(*call, 5);
  return "an instruction outside the local store";
}

dma::Fault fault_of_instruction(const Trap& trap, const std::byte* local_store, const std::string& place,
                                std::uint64_t main_memory_bytes) {
  const auto fault = [&](dma::Rule rule, const std::string& did) {
    return dma::Fault{.rule = rule, .detail = place + did};
  };
  if (trap.signal == SIGILL || trap.signal == SIGTRAP)
    return fault(dma::Rule::kIllegalInstruction, " is invalid");
  if (trap.signal == SIGFPE)
    return fault(dma::Rule::kIllegalInstruction,
                 " divides an integer by zero, or the smallest integer by -1, whose quotient has no place");
  if (trap.general_protection)  // pointers of 32 bits are all canonical
    return fault(
        dma::Rule::kOutsideLocalStore,
        " accessed a vector at an address that is no multiple of 16. An SPU ignores the lowest four bits "
        "of the address, the PC does not: clear them");
  const std::string did = trap.instruction_fetch ? " jumped to " : trap.write ? " wrote to " : " read from ";
  if (trap.address == 0)
    return fault(dma::Rule::kOutsideLocalStore, did + "address " + base::hex(0, 5) + ", by a null pointer" +
                                                    (trap.instruction_fetch ? " to a function" : ""));
  return fault_of_access(trap.address, begin_of(local_store), main_memory_bytes, place + did);
}

}  // namespace softcell::ls_sim::native
