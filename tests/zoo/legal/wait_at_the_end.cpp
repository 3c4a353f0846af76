// keeps: commands-outstanding
// Waits for its results to have left.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t results[32] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(results, envp, sizeof results, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return 0;
}
