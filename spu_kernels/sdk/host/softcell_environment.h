#pragma once
// How a kernel on the host reaches its channels: the emulator leaves a function pointer in the first quadwords of the local store, which the
// kernel finds from its stack pointer, since the stack lies in the local store and that is aligned to its size.

#include <stdint.h>

namespace softcell_sdk {

/// At local-store address 0. Written by the emulator when it loads an image; the kernel writes the mfc_ fields.
struct Environment {
  uint64_t gate;  ///< uint32_t gate(uint32_t operation, uint32_t value), System V calling convention
  uint32_t mfc_lsa, mfc_eah, mfc_eal, mfc_size, mfc_tag;  ///< channels 16 to 20
  uint32_t reserved[25];
};
static_assert(sizeof(Environment) == 128, "what ls.ld leaves free");

/// What is asked of the gate: kind << 8 | channel.
enum Kind : uint32_t { kRead = 0, kWrite = 1, kCount = 2, kStop = 3, kHalt = 4 };

constexpr uintptr_t kLocalStoreMask = 0x3FFFF;

inline Environment& environment() {
  uintptr_t stack_pointer;
  asm("mov %%rsp, %0" : "=r"(stack_pointer));
  return *reinterpret_cast<Environment*>(stack_pointer & ~kLocalStoreMask);
}

/// The local-store address of a pointer.
inline uint32_t local_store_address(const volatile void* pointer) {
  return static_cast<uint32_t>(reinterpret_cast<uintptr_t>(pointer) & kLocalStoreMask);
}

/// Memory may change in the call: DMA writes behind the compiler's back.
inline uint32_t call_gate(Kind kind, uint32_t channel, uint32_t value) {
  using Gate = uint32_t(uint32_t, uint32_t);
  asm volatile("" ::: "memory");
  const uint32_t reply = reinterpret_cast<Gate*>(environment().gate)(static_cast<uint32_t>(kind) << 8 | channel, value);
  asm volatile("" ::: "memory");
  return reply;
}

inline void write_channel(uint32_t channel, uint32_t value) {
  // The five parameters of a DMA command wait in the environment for the command itself.
  switch (channel) {
    case 16: environment().mfc_lsa = value; return;
    case 17: environment().mfc_eah = value; return;
    case 18: environment().mfc_eal = value; return;
    case 19: environment().mfc_size = value; return;
    case 20: environment().mfc_tag = value; return;
    default: call_gate(kWrite, channel, value);
  }
}

}  // namespace softcell_sdk
