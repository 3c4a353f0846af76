// Recurses until the stack has grown through everything below it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static int descend(volatile int* above, uint64_t depth) {
  volatile int here[64];
  here[0] = above[0] + 1;
  if (depth == 0) return here[0];
  return descend(here, depth - 1) + here[0];
}

int main(uint64_t, uint64_t, uint64_t envp) {
  volatile int start[1] = {0};
  return descend(start, envp) & 0;
}
