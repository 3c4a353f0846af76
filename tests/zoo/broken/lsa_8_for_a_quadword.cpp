// rule: lsa-alignment
// names: get
// twin: legal/quadword_at_offset_16
// Skips a header of 8 bytes in its buffer: transfers of 16 bytes and more begin at a multiple of 16.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer + 8, argp, 64, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
