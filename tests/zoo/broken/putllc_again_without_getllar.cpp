// rule: putllc-without-reservation
// names: putllc
// twin: legal/atomic_increment
// build: checked
// Tries putllc again without fetching the line again: the reservation was given up by the first one.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t line[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getllar(line, argp, 0, 0);
  mfc_read_atomic_status();
  line[0] = 1;
  mfc_putllc(line, argp, 0, 0);
  mfc_read_atomic_status();
  line[1] = 2;
  mfc_putllc(line, argp, 0, 0);  // BROKEN
  mfc_read_atomic_status();
  return 0;
}
