// rule: transfers-overlap
// names: getllar
// twin: legal/line_after_the_wait
// build: checked
// Stores a line by a put, which is queued, and looks at it at once: getllar does not wait for the queue.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t values[32] = {1}, line[32];

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(values, envp, sizeof values, 3, 0, 0);
  mfc_getllar(line, envp, 0, 0);  // BROKEN
  mfc_read_atomic_status();
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return 0;
}
