// rule: put-never-written
// names: put
// twin: legal/put_what_was_written
// build: checked
// Fills half of its buffer and puts all of it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t buffer[32];

int main(uint64_t, uint64_t, uint64_t envp) {
  for (uint32_t i = 0; i < 16; ++i) buffer[i] = i;
  mfc_put(buffer, envp, sizeof buffer, 3, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return 0;
}
