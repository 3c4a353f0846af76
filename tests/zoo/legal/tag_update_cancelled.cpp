// keeps: tag-update-pending
// Cancels a request by an immediate one and reads its answer before making the next.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_write_tag_update_any();
  mfc_write_tag_update_immediate();
  mfc_read_tag_status();
  mfc_read_tag_status_all();
  return buffer[1] == 1 ? 0 : 1;
}
