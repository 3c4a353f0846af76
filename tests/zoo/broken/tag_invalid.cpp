// rule: tag-out-of-range
// names: get
// twin: legal/tag_manager
// Uses what the tag manager answers without looking: all 32 tags were taken, and the answer is
// MFC_TAG_INVALID.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_multi_tag_reserve(32);
  mfc_get(buffer, argp, sizeof buffer, mfc_tag_reserve(), 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
