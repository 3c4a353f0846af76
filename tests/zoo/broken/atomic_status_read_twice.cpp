// rule: atomic-status-not-expected
// names: MFC_RdAtomicStat
// twin: legal/atomic_increment
// Reads the status once to test it and once to use it: the second read waits for ever.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getllar(line, argp, 0, 0);
  if ((mfc_read_atomic_status() & MFC_GETLLAR_STATUS) == 0) return 1;
  return static_cast<int>(mfc_read_atomic_status());  // BROKEN
}
