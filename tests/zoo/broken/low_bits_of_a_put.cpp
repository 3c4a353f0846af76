// rule: low-bits-differ
// names: put
// twin: legal/eight_bytes_at_offset_8
// Puts eight bytes from the middle of a quadword to the beginning of one.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static uint64_t pair[2] = {1, 2};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(&pair[1], envp, 8, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
