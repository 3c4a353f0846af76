// rule: tag-update-pending
// names: MFC_WrTagUpdate
// twin: legal/tag_update_cancelled
// Asks for any tag, changes its mind and asks for all, without reading or cancelling the first answer.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_write_tag_update_any();
  mfc_write_tag_update_all();  // BROKEN
  mfc_read_tag_status();
  return 0;
}
