// keeps: store-in-flight
// Reads from a buffer that is being put: nobody changes it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t buffer[32] = {1, 2, 3};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(buffer, envp, sizeof buffer, 3, 0, 0);
  const uint32_t sum = buffer[0] + buffer[1] + buffer[2];
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return sum == 6 ? 0 : 1;
}
