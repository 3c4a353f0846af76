// rule: tag-out-of-range
// names: get
// twin: legal/tag_31
// Gives the bit of the tag mask where the number of the tag is asked for.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 1u << 6, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 6);
  mfc_read_tag_status_all();
  return 0;
}
