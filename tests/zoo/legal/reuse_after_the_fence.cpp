// keeps: transfers-overlap
// Fetches into a buffer that is still being put: the fence orders the two, and one wait is enough.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32] = {7};

int main(uint64_t, uint64_t argp, uint64_t envp) {
  mfc_put(buffer, envp, sizeof buffer, 3, 0, 0);
  mfc_getf(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return buffer[0] == 0 && buffer[1] == 1 ? 0 : 1;
}
