// rule: ea-not-writable
// names: put
// twin: legal/get_from_read_only
// envp: read-only
// Puts its results over its input, which SPEs may only read.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(buffer, envp, sizeof buffer, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
