// keeps: lsa-alignment, low-bits-differ
// A word from offset 8 to offset 8: the low four bits of both addresses are equal.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static uint32_t words[4];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(&words[2], argp + 40, 4, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return words[2] == 10 ? 0 : 1;
}
