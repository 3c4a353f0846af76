// rule: ea-alignment
// names: get
// twin: legal/eight_bytes_at_offset_8
// Skips a header of 8 bytes in main storage and fetches the rest in one go.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp + 8, 64, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
