// rule: tag-status-not-requested
// names: MFC_RdTagStat
// twin: legal/tag_status_counted
// Reads the status without asking for it: the SPU waits for an answer that nobody will give.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status();  // BROKEN
  return 0;
}
