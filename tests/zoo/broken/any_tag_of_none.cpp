// rule: tag-mask-empty
// names: MFC_RdTagStat
// twin: legal/empty_mask_asked_at_once
// Waits for any tag of an empty mask: none of no tags is ever complete.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_mask(0);
  mfc_read_tag_status_any();  // BROKEN
  return 0;
}
