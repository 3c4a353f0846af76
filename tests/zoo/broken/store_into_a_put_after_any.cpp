// rule: store-in-flight
// names: put
// twin: legal/reuse_after_the_wait
// build: checked
// Waits for any of two tags and uses both buffers again.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t first[32] = {1}, second[32] = {2};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(first, envp, sizeof first, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_any();
  mfc_put(second, envp + 128, sizeof second, 1, 0, 0);
  first[0] = 3;
  second[0] = 4;  // BROKEN
  mfc_write_tag_mask(1u << 1);
  mfc_read_tag_status_all();
  return 0;
}
