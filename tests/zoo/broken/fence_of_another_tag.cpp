// rule: transfers-overlap
// names: getf
// twin: legal/reuse_after_the_barrier
// build: checked
// Has a fence, but the put before it has another tag: a fence orders its own tag group only.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32] = {1};

int main(uint64_t, uint64_t argp, uint64_t envp) {
  mfc_put(buffer, envp, sizeof buffer, 3, 0, 0);
  mfc_getf(buffer, argp, sizeof buffer, 4, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 3 | 1u << 4);
  mfc_read_tag_status_all();
  return 0;
}
