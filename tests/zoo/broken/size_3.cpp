// rule: size-not-legal
// names: get
// twin: legal/small_sizes
// Fetches one RGB pixel and no more than it needs: the MFC moves 1, 2, 4 or 8 bytes, never 3.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static unsigned char pixel[16];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(pixel, argp, 3, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
