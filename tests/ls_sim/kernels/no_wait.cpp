// Reads its buffer without waiting for the transfer: right under the eager schedule, wrong under the lazy
// one.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t buffer[32];
alignas(128) static uint32_t out[32];

int main(uint64_t, uint64_t argp, uint64_t envp) {
  for (int i = 0; i < 32; ++i) buffer[i] = 0;
  mfc_get(const_cast<uint32_t*>(buffer), argp, sizeof buffer, 0, 0, 0);
  for (int i = 0; i < 32; ++i) out[i] = buffer[i];
  mfc_put(out, envp, sizeof out, 1, 0, 0);
  mfc_write_tag_mask(3);
  mfc_read_tag_status_all();
  return 0;
}
