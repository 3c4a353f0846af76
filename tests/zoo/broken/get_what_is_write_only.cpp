// rule: ea-not-readable
// names: get
// twin: legal/put_to_write_only
// envp: write-only
// Reads back results from a buffer that SPEs may only write.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_get(buffer, envp, sizeof buffer, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
