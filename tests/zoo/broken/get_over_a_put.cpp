// rule: transfers-overlap
// names: get
// twin: legal/reuse_after_the_fence
// build: checked
// Fetches the next block into a buffer that is still being put: same tag, but no fence.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32] = {1};

int main(uint64_t, uint64_t argp, uint64_t envp) {
  mfc_put(buffer, envp, sizeof buffer, 3, 0, 0);
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return 0;
}
