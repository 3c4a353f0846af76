// rule: outside-objects
// names: get
// twin: legal/last_element_of_an_object
// build: checked
// Fetches a block of 256 bytes into a buffer of 128.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, 256, 3, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return 0;
}
