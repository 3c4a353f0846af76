// rule: store-in-flight
// names: get of 4 bytes, tag 3
// twin: legal/store_beside_a_put
// build: checked
// Stores to the first word while the second is on its way: an SPU stores whole quadwords, and writes back the old second word.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t words[4] = {1, 2, 3, 4};

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(&words[1], argp + 4, 4, 3, 0, 0);
  words[0] = 5;  // BROKEN
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return words[0] == 5 ? 0 : 1;
}
