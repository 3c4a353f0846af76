// rule: atomic-alignment
// names: getllar
// twin: legal/atomic_increment
// Reserves into a buffer that is aligned to 16 bytes only: the line commands want multiples of 128 on
// both sides.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[64];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getllar(&line[4], argp, 0, 0);  // BROKEN
  mfc_read_atomic_status();
  return 0;
}
