// keeps: ea-not-writable
// envp: read-only
// What SPEs may only read, read by a get and by getllar.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32], line[32];

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_get(buffer, envp, sizeof buffer, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  mfc_getllar(line, envp, 0, 0);
  mfc_read_atomic_status();
  return buffer[0] == line[0] ? 0 : 1;
}
