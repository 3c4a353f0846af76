// rule: list-address
// names: getl
// twin: legal/list_at_multiple_of_8
// Builds its list behind a count of four bytes: lists lie at multiples of 8.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];
alignas(8) static uint32_t block[5];

int main(uint64_t, uint64_t argp, uint64_t) {
  block[0] = 1;
  block[1] = 128;  // the list: size and address of its only element
  block[2] = mfc_ea2l(argp);
  mfc_getl(buffer, argp, &block[1], 8, 5, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return 0;
}
