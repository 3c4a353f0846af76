// Computes for argp rounds and reaches no channel meanwhile; before, with envp 1, it executes a sync.
#include <spu_intrinsics.h>
#include <stdint.h>

int main(uint64_t, uint64_t argp, uint64_t envp) {
  if (envp == 1) spu_sync();
  uint32_t x = 1;
  for (uint64_t round = 0; round < argp; ++round) {
    x = x * 1664525u + 1013904223u;
    asm volatile("" : "+r"(x));
  }
  return x == 0 ? 1 : 0;
}
