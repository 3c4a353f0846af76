// keeps: transfers-overlap
// As with the fence, but the two have different tags: the barrier command orders all.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32] = {7};

int main(uint64_t, uint64_t argp, uint64_t envp) {
  mfc_put(buffer, envp, sizeof buffer, 3, 0, 0);
  mfc_barrier(4);
  mfc_get(buffer, argp, sizeof buffer, 4, 0, 0);
  mfc_write_tag_mask(1u << 3 | 1u << 4);
  mfc_read_tag_status_all();
  return buffer[0] == 0 && buffer[1] == 1 ? 0 : 1;
}
