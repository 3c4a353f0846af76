// keeps: store-in-flight
// Waits for the put before it writes to the buffer again.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t message[32] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(message, envp, sizeof message, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  message[0] = 2;
  mfc_put(message, envp + 128, sizeof message, 3, 0, 0);
  mfc_read_tag_status_all();
  return 0;
}
