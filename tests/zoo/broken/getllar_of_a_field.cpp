// rule: atomic-alignment
// names: getllar
// twin: legal/atomic_increment
// Gives the address of the counter where that of its line is asked for.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[32] = {1};

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getllar(line, argp + 4, 0, 0);  // BROKEN
  mfc_read_atomic_status();
  return 0;
}
