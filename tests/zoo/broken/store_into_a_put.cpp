// rule: store-in-flight
// names: put
// twin: legal/reuse_after_the_wait
// build: checked
// Prepares the next message in the buffer from which the last one is still leaving.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t message[32] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(message, envp, sizeof message, 3, 0, 0);
  message[0] = 2;  // BROKEN
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return 0;
}
