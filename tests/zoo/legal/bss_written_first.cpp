// keeps: load-never-written
// Writes a variable without initial value before reading it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static volatile uint32_t sum;

int main(uint64_t, uint64_t, uint64_t) {
  sum = 0;
  sum = sum + 1;
  return sum == 1 ? 0 : 1;
}
