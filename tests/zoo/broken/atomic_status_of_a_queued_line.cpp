// rule: atomic-status-not-expected
// names: MFC_RdAtomicStat
// twin: legal/putqlluc_waits_for_its_tag
// Waits for putqlluc as for the other line commands: it is queued, and has a tag instead of a status.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[32] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_putqlluc(line, envp, 2, 0, 0);
  mfc_read_atomic_status();  // BROKEN
  return 0;
}
