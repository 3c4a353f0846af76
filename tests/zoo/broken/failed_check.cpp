// rule: kernel-halt
// twin: legal/passed_check
// Checks its arguments by a halt, which is how SPU code asserts.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static volatile uint32_t count = 65;

int main(uint64_t, uint64_t, uint64_t) {
  const uint32_t items = count;
  spu_hcmpgt(items, 64u);  // BROKEN
  return 0;
}
