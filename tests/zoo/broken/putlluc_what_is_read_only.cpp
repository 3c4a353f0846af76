// rule: ea-not-writable
// names: putlluc
// twin: legal/get_from_read_only
// envp: read-only
// Stores a line into a buffer that SPEs may only read.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[32] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_putlluc(line, envp, 0, 0);  // BROKEN
  mfc_read_atomic_status();
  return 0;
}
