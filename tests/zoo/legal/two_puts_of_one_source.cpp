// keeps: transfers-overlap
// Two puts in flight from the same bytes: neither writes them.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32] = {7};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(buffer, envp, sizeof buffer, 3, 0, 0);
  mfc_put(buffer, envp + 128, sizeof buffer, 4, 0, 0);
  mfc_write_tag_mask(1u << 3 | 1u << 4);
  mfc_read_tag_status_all();
  return 0;
}
