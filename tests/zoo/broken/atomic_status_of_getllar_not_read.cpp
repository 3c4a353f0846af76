// rule: atomic-status-not-read
// names: getllar
// twin: legal/atomic_increment
// build: checked
// Goes from getllar to putllc without reading the status between: the line may not be there yet.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getllar(line, argp, 0, 0);
  mfc_putllc(line, argp, 0, 0);  // BROKEN
  mfc_read_atomic_status();
  return 0;
}
