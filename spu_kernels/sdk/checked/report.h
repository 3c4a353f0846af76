#pragma once
// How what stands in for a load or store tells the emulator of it.

#include <stddef.h>
#include <stdint.h>

#include "../host/softcell_environment.h"

namespace softcell_checked {

using softcell_sdk::Environment;

/// A load or store; or the C library tells of a block of its heap, which it has given to the program or is about to take back; or a load or
/// store that is not in the local store: its address is all that the emulator gets.
enum Direction : uint32_t {
  kLoad = 0,
  kStore = 1,
  kHeapBlock = 2,
  kFreedBlock = 3,
  kLoadElsewhere = 4,
  kStoreElsewhere = 5
};

__attribute__((noinline)) static void report(const volatile void* pointer, size_t bytes, Direction direction,
                                             void* return_address, void* stack_pointer) {
  const auto address = reinterpret_cast<uintptr_t>(pointer);
  if (bytes == 0) return;
  const bool is_here = (address & ~softcell_sdk::kLocalStoreMask) == softcell_sdk::local_store_base();
  const uint32_t lsa = softcell_sdk::local_store_address(pointer);
  if (is_here && lsa < sizeof(Environment)) return;  // a command's parameters on their way
  Environment& environment = softcell_sdk::environment();
  environment.access_bytes =
      bytes > softcell_sdk::kLocalStoreMask ? softcell_sdk::kLocalStoreMask : static_cast<uint32_t>(bytes);
  environment.access_instruction = softcell_sdk::local_store_address(return_address) - 1;
  environment.access_stack_pointer = softcell_sdk::local_store_address(stack_pointer);
  if (!is_here) {
    if (direction == kHeapBlock || direction == kFreedBlock) return;
    softcell_sdk::call_gate(softcell_sdk::kAccess, direction == kStore ? kStoreElsewhere : kLoadElsewhere,
                            static_cast<uint32_t>(address));
    return;
  }
  softcell_sdk::call_gate(softcell_sdk::kAccess, direction, lsa);
}

}  // namespace softcell_checked

// In a function that the kernel's code has called: how it was called.
#define SC_REPORT(pointer, bytes, direction)                                                         \
  softcell_checked::report(pointer, bytes, softcell_checked::direction, __builtin_return_address(0), \
                           __builtin_dwarf_cfa())
