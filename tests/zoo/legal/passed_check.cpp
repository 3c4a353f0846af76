// keeps: kernel-halt
// The check holds: the halt is not executed.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static volatile uint32_t count = 64;

int main(uint64_t, uint64_t, uint64_t) {
  const uint32_t items = count;
  spu_hcmpgt(items, 64u);
  return 0;
}
