// What the checked image of a kernel is linked with: the functions that the compiler calls before each load
// and store. Each tells the emulator, which keeps the books (ls_sim/src/checker/checker.h), and returns.
//
// The compilers offer such calls for their sanitizers, of which nothing else is used here. GCC's for the
// address sanitizer leave out what lies within a variable anyway, so its kernels are built for the thread
// sanitizer's; clang's for that one leave out vectors of 32 bytes, so its kernels are built for the kernel
// address sanitizer's.

#include "report.h"

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
