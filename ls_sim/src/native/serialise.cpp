// Runs on a kernel's stack: built without sanitizers, as kernel_side.cpp.

#include "serialise.h"

#include <cpuid.h>

// An interrupt return to the instruction behind it, on the same stack and at the same privilege.
// [Intel SDM 3, serializing instructions; AMD64 manual 2, serializing instructions] documented
extern "C" void softcell_iret_to_next();
asm(R"(
        .text
        .p2align 4
        .type   softcell_iret_to_next, @function
softcell_iret_to_next:
        .cfi_startproc
        movq    %rsp, %rax
        movl    %ss, %ecx
        pushq   %rcx
        .cfi_adjust_cfa_offset 8
        pushq   %rax
        .cfi_adjust_cfa_offset 8
        pushfq
        .cfi_adjust_cfa_offset 8
        movl    %cs, %ecx
        pushq   %rcx
        .cfi_adjust_cfa_offset 8
        leaq    1f(%rip), %rcx
        pushq   %rcx
        .cfi_adjust_cfa_offset 8
        iretq
        .cfi_def_cfa_offset 8
1:      ret
        .cfi_endproc
        .size   softcell_iret_to_next, . - softcell_iret_to_next
)");

namespace softcell::ls_sim::native {
namespace {

bool has_serialize() {
  unsigned int a = 0, b = 0, c = 0, d = 0;
  constexpr unsigned int kSerializeBit = 1u << 14;  // [Intel SDM 2, CPUID leaf 7] documented
  return __get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && (d & kSerializeBit) != 0;
}

const bool serialize_is_there = has_serialize();  // asked once: CPUID is what is to be avoided

}  // namespace

void serialise() {
  if (serialize_is_there) {
    asm volatile(".byte 0x0F, 0x01, 0xE8" ::: "memory");  // SERIALIZE, which older assemblers do not know
  } else {
    softcell_iret_to_next();
  }
}

}  // namespace softcell::ls_sim::native
