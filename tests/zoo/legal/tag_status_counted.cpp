// keeps: tag-status-not-requested
// Asks once, looks at the channel's count until there is an answer, and reads it once.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_write_tag_update_all();
  while (mfc_stat_tag_status() == 0) {
  }
  return mfc_read_tag_status() == 1u << 3 && buffer[1] == 1 ? 0 : 1;
}
