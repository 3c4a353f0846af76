// rule: putllc-without-reservation
// names: putllc
// twin: legal/atomic_increment
// build: checked
// Reserves the lock and stores the data behind it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getllar(line, argp, 0, 0);
  mfc_read_atomic_status();
  mfc_putllc(line, argp + 128, 0, 0);  // BROKEN
  mfc_read_atomic_status();
  return 0;
}
