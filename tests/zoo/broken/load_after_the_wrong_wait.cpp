// rule: load-in-flight
// names: get
// twin: legal/double_buffer
// build: checked
// Swaps the tags of its two buffers: waits for the second and reads the first.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t first[32], second[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(first, argp, sizeof first, 0, 0, 0);
  mfc_get(second, argp + 128, sizeof second, 1, 0, 0);
  mfc_write_tag_mask(1u << 1);
  mfc_read_tag_status_all();
  const uint32_t word = first[0];  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return word == 0xFFFFFFFFu ? 1 : 0;
}
