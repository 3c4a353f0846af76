// keeps: video-memory-write
// envp: video
// Video memory may be read: slow on the console, but legal.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32];

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_get(buffer, envp, sizeof buffer, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return buffer[0] == 0 ? 0 : 1;
}
