// rule: transfers-overlap
// names: get
// twin: legal/reuse_after_the_fence
// build: checked
// Fetches two blocks to the same place, the second of which it wants: they may arrive in any order.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_get(buffer, argp + 128, sizeof buffer, 3, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return 0;
}
