// rule: load-never-written
// twin: legal/bss_written_first
// build: checked
// Fetches half a buffer and works on all of it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, 64, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return buffer[16] == 0xFFFFFFFFu ? 1 : 0;  // BROKEN
}
