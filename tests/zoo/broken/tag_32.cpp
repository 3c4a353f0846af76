// rule: tag-out-of-range
// names: get
// twin: legal/tag_31
// Counts tags from 1 to 32; they go from 0 to 31.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 32, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 31);
  mfc_read_tag_status_all();
  return 0;
}
