// rule: atomic-status-not-read
// names: putllc
// twin: legal/atomic_increment
// build: checked
// Ends without looking whether its putllc has stored anything.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getllar(line, argp, 0, 0);
  mfc_read_atomic_status();
  line[0] += 1;
  mfc_putllc(line, argp, 0, 0);  // BROKEN
  return 0;
}
