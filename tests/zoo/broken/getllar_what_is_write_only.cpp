// rule: ea-not-readable
// names: getllar
// twin: legal/put_to_write_only
// envp: write-only
// Reserves a line of a buffer that SPEs may only write.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[32];

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_getllar(line, envp, 0, 0);  // BROKEN
  mfc_read_atomic_status();
  return 0;
}
