// rule: load-in-flight
// names: get
// twin: legal/load_after_the_wait
// build: checked
// Reads what it has fetched before waiting for it: on a quiet machine the bytes are often there already.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  const uint32_t first = buffer[0];  // BROKEN
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return first == 0xFFFFFFFFu ? 1 : 0;
}
