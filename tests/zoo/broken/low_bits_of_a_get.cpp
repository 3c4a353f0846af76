// rule: low-bits-differ
// names: get
// twin: legal/four_bytes_at_offset_8
// Fetches the second word of a record to the beginning of a buffer: both addresses are multiples of 4,
// but small transfers keep their place in the quadword.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static uint32_t word;

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(&word, argp + 4, 4, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
