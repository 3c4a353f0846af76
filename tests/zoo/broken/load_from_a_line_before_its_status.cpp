// rule: load-in-flight
// names: getllar
// twin: legal/atomic_status_asked_for
// build: checked
// Reads a lock from the line that getllar fetches, and its status afterwards: the lock may be that of the line before.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t line[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getllar(line, argp, 0, 0);
  const uint32_t lock = line[0];  // BROKEN
  mfc_read_atomic_status();
  return lock == 0xFFFFFFFFu ? 1 : 0;
}
