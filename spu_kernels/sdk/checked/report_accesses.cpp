// What the checked flavour of a kernel is linked with: the functions that the compiler calls before each load
// and store. Each tells the emulator, which keeps the books (ls_sim/checker.h), and returns.
//
// The compilers offer such calls for their sanitizers, of which nothing else is used here. GCC's for the
// address sanitizer leave out what lies within a variable anyway, so its kernels are built for the thread
// sanitizer's; clang's for that one leave out vectors of 32 bytes, so its kernels are built for the kernel
// address sanitizer's.

#include <stddef.h>
#include <stdint.h>

#include "../host/softcell_environment.h"

namespace {

using softcell_sdk::Environment;

enum Direction : uint32_t { kLoad = 0, kStore = 1 };

__attribute__((noinline)) void report(const volatile void* pointer, size_t bytes, Direction direction,
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

}  // namespace

// In a function that the kernel's code has called: how it was called.
#define SC_REPORT(pointer, bytes, direction) \
  report(pointer, bytes, direction, __builtin_return_address(0), __builtin_dwarf_cfa())

#define SC_FIXED(function, bytes, direction) \
  extern "C" void function(const volatile void* at) { SC_REPORT(at, bytes, direction); }
#define SC_RANGE(function, direction) \
  extern "C" void function(const volatile void* at, size_t bytes) { SC_REPORT(at, bytes, direction); }

// GCC.
#define SC_EACH_SIZE(bytes)                              \
  SC_FIXED(__tsan_read##bytes, bytes, kLoad)             \
  SC_FIXED(__tsan_write##bytes, bytes, kStore)           \
  SC_FIXED(__tsan_unaligned_read##bytes, bytes, kLoad)   \
  SC_FIXED(__tsan_unaligned_write##bytes, bytes, kStore) \
  /* clang */                                            \
  SC_FIXED(__asan_load##bytes##_noabort, bytes, kLoad)   \
  SC_FIXED(__asan_store##bytes##_noabort, bytes, kStore)
SC_EACH_SIZE(1)
SC_EACH_SIZE(2)
SC_EACH_SIZE(4)
SC_EACH_SIZE(8)
SC_EACH_SIZE(16)
SC_RANGE(__tsan_read_range, kLoad)
SC_RANGE(__tsan_write_range, kStore)
SC_RANGE(__asan_loadN_noabort, kLoad)
SC_RANGE(__asan_storeN_noabort, kStore)

// The pointer to a virtual table, which constructors and destructors store.
extern "C" void __tsan_vptr_update(const volatile void* at, void*) { SC_REPORT(at, sizeof(void*), kStore); }
extern "C" void __tsan_vptr_read(const volatile void* at) { SC_REPORT(at, sizeof(void*), kLoad); }

/// Called by a constructor that both compilers add, and that ls.ld drops.
extern "C" void __tsan_init() {}
extern "C" void __asan_handle_no_return() {}

// What compilers make of copies and of variables that are set to zero. A kernel's own win over these.

extern "C" __attribute__((weak)) void* memcpy(void* to, const void* from, size_t bytes) {
  SC_REPORT(from, bytes, kLoad);
  SC_REPORT(to, bytes, kStore);
  // The instruction takes all 64 bits of its registers.
  uint64_t destination = reinterpret_cast<uintptr_t>(to), source = reinterpret_cast<uintptr_t>(from),
           left = bytes;
  asm volatile("rep movsb" : "+D"(destination), "+S"(source), "+c"(left) : : "memory");
  return to;
}

extern "C" __attribute__((weak)) void* memmove(void* to, const void* from, size_t bytes) {
  SC_REPORT(from, bytes, kLoad);
  SC_REPORT(to, bytes, kStore);
  auto* const destination = static_cast<unsigned char*>(to);
  const auto* const source = static_cast<const unsigned char*>(from);
  if (destination <= source) {
    for (size_t i = 0; i < bytes; ++i) destination[i] = source[i];
  } else {
    for (size_t i = bytes; i-- > 0;) destination[i] = source[i];
  }
  return to;
}

extern "C" __attribute__((weak)) void* memset(void* to, int value, size_t bytes) {
  SC_REPORT(to, bytes, kStore);
  uint64_t destination = reinterpret_cast<uintptr_t>(to), left = bytes;
  asm volatile("rep stosb" : "+D"(destination), "+c"(left) : "a"(value) : "memory");
  return to;
}
