// rule: reservation-not-used
// names: getllar
// twin: legal/line_changed_and_stored
// build: checked
// Changes a counter in its copy of the line and forgets to store it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t line[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getllar(line, argp, 0, 0);  // BROKEN
  mfc_read_atomic_status();
  line[0] = line[0] + 1;
  return 0;
}
