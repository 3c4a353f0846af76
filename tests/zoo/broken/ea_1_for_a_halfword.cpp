// rule: ea-alignment
// names: put
// twin: legal/small_sizes
// Puts a halfword into a packed record, at an odd address.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static uint16_t value = 7;

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(&value, envp + 1, 2, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
