// rule: tag-update-condition
// names: MFC_WrTagUpdate
// twin: legal/tag_status_polled
// Writes the number of the tag where the condition is asked for: 0 immediate, 1 any, 2 all.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_write_tag_update(3);  // BROKEN
  mfc_read_tag_status();
  return 0;
}
