// rule: tag-status-not-requested
// names: MFC_RdTagStat
// twin: legal/tag_status_counted
// Reads one answer twice.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return static_cast<int>(mfc_read_tag_status());  // BROKEN
}
