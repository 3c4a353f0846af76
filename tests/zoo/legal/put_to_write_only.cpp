// keeps: ea-not-readable
// envp: write-only
// What SPEs may only write, written.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(buffer, envp, sizeof buffer, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
