// rule: commands-outstanding
// names: put
// twin: legal/one_wait_for_two_tags
// build: checked
// Waits for one of its two tags.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t results[64] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(&results[0], envp, 128, 0, 0, 0);
  mfc_put(&results[32], envp + 128, 128, 1, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
