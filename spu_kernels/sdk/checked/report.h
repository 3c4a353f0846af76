#pragma once
// How what stands in for a load or store tells the emulator of it.

#include <stddef.h>
#include <stdint.h>

#include "../host/softcell_environment.h"

namespace softcell_checked {

using softcell_sdk::Environment;

/// A load or store; or the C library tells of a block of its heap, which it has given to the program or is about to take back.
enum Direction : uint32_t { kLoad = 0, kStore = 1, kHeapBlock = 2, kFreedBlock = 3 };

__attribute__((noinline)) static void report(const volatile void* pointer, size_t bytes, Direction direction,
                                             void* return_address, void* stack_pointer) {
  const auto address = reinterpret_cast<uintptr_t>(pointer);
  // No local store at all: the processor finds that by itself.
  if ((address & ~softcell_sdk::kLocalStoreMask) != softcell_sdk::local_store_base() || bytes == 0) return;
  const uint32_t lsa = softcell_sdk::local_store_address(pointer);
  if (lsa < sizeof(Environment)) return;  // a command's parameters on their way
  Environment& environment = softcell_sdk::environment();
  environment.access_bytes =
      bytes > softcell_sdk::kLocalStoreMask ? softcell_sdk::kLocalStoreMask : static_cast<uint32_t>(bytes);
  environment.access_instruction = softcell_sdk::local_store_address(return_address) - 1;
  environment.access_stack_pointer = softcell_sdk::local_store_address(stack_pointer);
  softcell_sdk::call_gate(softcell_sdk::kAccess, direction, lsa);
}

}  // namespace softcell_checked

// In a function that the kernel's code has called: how it was called.
#define SC_REPORT(pointer, bytes, direction)                                                         \
  softcell_checked::report(pointer, bytes, softcell_checked::direction, __builtin_return_address(0), \
                           __builtin_dwarf_cfa())
