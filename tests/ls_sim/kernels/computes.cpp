// Computes for argp rounds and reaches no channel meanwhile; before, with envp 1, it executes a sync, with envp 2 one with the host
// processor's direction flag set, with which string instructions go backwards. With envp 3 it ends with that flag.
#include <spu_intrinsics.h>
#include <stdint.h>

static void set_direction_flag() {
#ifdef __x86_64__
  asm volatile("std" ::: "cc");
#endif
}

int main(uint64_t, uint64_t argp, uint64_t envp) {
  if (envp == 2) set_direction_flag();
  if (envp == 1 || envp == 2) spu_sync();
  uint32_t x = 1;
  for (uint64_t round = 0; round < argp; ++round) {
    x = x * 1664525u + 1013904223u;
    asm volatile("" : "+r"(x));
  }
  if (envp == 3) set_direction_flag();
  return x == 0 ? 1 : 0;
}
