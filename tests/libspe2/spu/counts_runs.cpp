// Counts the runs of its context in initialised data and in bss. Returns both counts.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static volatile int initialised = 5;
static volatile int zero;

int main(uint64_t, uint64_t, uint64_t) {
  initialised = initialised + 1;
  zero = zero + 1;
  return initialised * 10 + zero;
}
