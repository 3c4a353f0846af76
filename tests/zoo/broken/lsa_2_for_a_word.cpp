// rule: lsa-alignment
// names: get
// twin: legal/four_bytes_at_offset_8
// Fetches a word to a place for halfwords.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer + 2, argp, 4, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
