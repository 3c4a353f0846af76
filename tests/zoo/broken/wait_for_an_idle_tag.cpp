// rule: tag-without-command
// names: tag 4
// twin: legal/one_wait_for_two_tags
// build: checked
// Waits once more, for a tag with which nothing was issued: probably the wrong one.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  mfc_write_tag_mask(1u << 4);
  mfc_read_tag_status_all();  // BROKEN
  return 0;
}
