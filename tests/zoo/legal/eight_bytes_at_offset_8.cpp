// keeps: ea-alignment, low-bits-differ
// Eight bytes behind a header of eight, on both sides.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static uint32_t words[4];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(&words[2], argp + 8, 8, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return words[3] == 3 ? 0 : 1;
}
