// rule: store-in-flight
// names: putllc
// twin: legal/atomic_status_asked_for
// build: checked
// Prepares the next value of a line in the place from which putllc may still be storing the last one.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t line[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getllar(line, argp, 0, 0);
  mfc_read_atomic_status();
  mfc_putllc(line, argp, 0, 0);
  line[0] = 2;  // BROKEN
  mfc_read_atomic_status();
  return 0;
}
