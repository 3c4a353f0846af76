/* How a C kernel on the host reaches its channels: softcell_environment.h, which says how it works, in C. */
#ifndef SOFTCELL_C_ENVIRONMENT_H
#define SOFTCELL_C_ENVIRONMENT_H

#include "softcell_c_types.h"

struct softcell_environment {
  uint64_t gate;
  uint32_t mfc_lsa, mfc_eah, mfc_eal, mfc_size, mfc_tag, mfc_tag_mask;
};

enum {
  softcell_read = 0,
  softcell_write = 1,
  softcell_count = 2,
  softcell_stop = 3,
  softcell_halt = 4,
  softcell_tag_status = 5,
  softcell_sync = 8,
  softcell_assist = 9
};

SC_C_INLINE volatile struct softcell_environment* softcell_environment(void) {
  uint64_t stack_pointer;
  __asm__("movq %%rsp, %q0" : "=r"(stack_pointer));
  return (volatile struct softcell_environment*)((uintptr_t)stack_pointer & ~(uintptr_t)0x3FFFF);
}

/* The local-store address of a pointer. */
SC_C_INLINE uint32_t softcell_lsa(const volatile void* pointer) {
  return (uint32_t)(uintptr_t)pointer & 0x3FFFF;
}

SC_C_INLINE uint32_t softcell_call_gate(uint32_t kind, uint32_t channel, uint32_t value) {
  typedef uint32_t gate_function(uint32_t, uint32_t);
  uint32_t reply;
  __asm__ volatile("" ::: "memory");
  reply = ((gate_function*)(uintptr_t)softcell_environment()->gate)(kind << 8 | channel, value);
  __asm__ volatile("" ::: "memory");
  return reply;
}

SC_C_INLINE void softcell_write_channel(uint32_t channel, uint32_t value) {
  switch (channel) {
    case 16:
      softcell_environment()->mfc_lsa = value;
      break;
    case 17:
      softcell_environment()->mfc_eah = value;
      break;
    case 18:
      softcell_environment()->mfc_eal = value;
      break;
    case 19:
      softcell_environment()->mfc_size = value;
      break;
    case 20:
      softcell_environment()->mfc_tag = value;
      break;
    case 22:
      softcell_environment()->mfc_tag_mask = value;
      break;
    default:
      softcell_call_gate(softcell_write, channel, value);
      break;
  }
}

/* A compile-time error unless the value is a constant between the two. */
#define SC_C_CONSTANT(value, low, high)                                                                 \
  ((int)(value) + 0 * (int)sizeof(struct {                                                              \
                    int not_a_constant_in_its_range : ((value) >= (low) && (value) <= (high)) ? 1 : -1; \
                  }))

#endif
