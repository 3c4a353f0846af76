#pragma once
// How a kernel on the host reaches its channels. The emulator leaves the address of a function, the gate, in
// the first bytes of the local store. The kernel finds them from its stack pointer: its stack lies in the
// local store, and that is aligned to its size of 256 KB. Nothing here needs a relocation, so an image runs
// wherever it is copied.

#include <stdint.h>

namespace softcell_sdk {

/// At local-store address 0. The emulator writes `gate` when it loads an image, the kernel the mfc_ fields:
/// channels that only hold a value until another channel is used, so that it need not be called for them.
struct Environment {
  /// Address of uint32_t gate(uint32_t operation, uint32_t value), System V calling convention. It lies below
  /// 4 GB, as all that a kernel's 32-bit pointers may point to.
  uint64_t gate;
  uint32_t mfc_lsa, mfc_eah, mfc_eal, mfc_size, mfc_tag;  ///< channels 16 to 20
  uint32_t mfc_tag_mask;                                  ///< channel 22; 0 when a run begins
  // Of a checked kernel's load or store, besides its address (see sdk/checked/report_accesses.cpp).
  uint32_t access_bytes;
  uint32_t access_instruction, access_stack_pointer;  ///< local-store addresses
  uint32_t padding;
  // Of a job that a kernel is about to call (see mark_job_begin()).
  uint64_t job_image_ea, job_ea;
  // Of the last call of the PPU side (kAssist): its word, which on an SPU is behind the instruction.
  uint32_t assist;
  uint32_t reserved[15];
};
static_assert(sizeof(Environment) == 128, "what the link script leaves free");

/// What is asked of the gate: operation = kind << 8 | channel. `value` is what is written, or the stop code.
/// kTagStatus writes `value` to MFC_WrTagUpdate and then reads MFC_RdTagStat: one call for each wait.
/// kAccess reports a load or store of a checked kernel: its direction (checked/report.h) as the channel, and its
/// address as the value. kJob says that a job begins (1 as the channel) or has ended. kSync
/// makes the processor fetch anew what it executes. kAssist stops with code 0x2100 + channel, which calls a
/// function of the PPU side; `value` is its number in the upper 8 bits, and the local-store address of its
/// arguments, a quadword each.
enum GateKind : uint32_t {
  kRead = 0,
  kWrite = 1,
  kCount = 2,
  kStop = 3,
  kHalt = 4,
  kTagStatus = 5,
  kAccess = 6,
  kJob = 7,
  kSync = 8,
  kAssist = 9
};

constexpr uintptr_t kLocalStoreMask = 0x3FFFF;

/// Where the local store lies in the host's memory.
__attribute__((always_inline)) inline uintptr_t local_store_base() {
  // Local stores lie below 4 GB, and the tests that include this from ordinary host code have 64-bit pointers.
  uint64_t stack_pointer;
  asm("movq %%rsp, %q0" : "=r"(stack_pointer));
  return static_cast<uintptr_t>(stack_pointer) & ~kLocalStoreMask;
}

__attribute__((always_inline)) inline Environment& environment() {
  return *reinterpret_cast<Environment*>(local_store_base());
}

/// The local-store address of a pointer. For a pointer to somewhere else it means nothing, as on the SPU.
__attribute__((always_inline)) inline uint32_t local_store_address(const volatile void* pointer) {
  return static_cast<uint32_t>(reinterpret_cast<uintptr_t>(pointer) & kLocalStoreMask);
}

/// DMA writes the local store behind the compiler's back, so that no value of memory survives the call.
__attribute__((always_inline)) inline uint32_t call_gate(GateKind kind, uint32_t channel, uint32_t value) {
  using Gate = uint32_t(uint32_t, uint32_t);
  asm volatile("" ::: "memory");
  const uint32_t reply =
      reinterpret_cast<Gate*>(static_cast<uintptr_t>(environment().gate))(kind << 8 | channel, value);
  asm volatile("" ::: "memory");
  return reply;
}

/// Tells the emulator, for its messages and statistics, which job begins or has ended inside a kernel that
/// runs many.
__attribute__((always_inline)) inline void mark_job_begin(uint64_t image_ea, uint64_t job_ea) {
  environment().job_image_ea = image_ea;
  environment().job_ea = job_ea;
  call_gate(kJob, 1, 0);
}
__attribute__((always_inline)) inline void mark_job_end() { call_gate(kJob, 0, 0); }

}  // namespace softcell_sdk
