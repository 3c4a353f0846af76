// rule: load-never-written
// twin: legal/bss_written_first
// build: checked
// Counts on a variable without initial value to be zero: bss holds what the last job left there.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static volatile uint32_t sum;

int main(uint64_t, uint64_t, uint64_t) {
  const uint32_t before = sum;  // BROKEN
  sum = before + 1;
  return 0;
}
