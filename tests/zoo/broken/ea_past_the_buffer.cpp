// rule: ea-crosses-buffer
// names: get
// twin: legal/last_bytes_of_buffer
// Fetches whole blocks, though the data end in the middle of the last one.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char block[256];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(block, argp + 65536 - 128, sizeof block, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
