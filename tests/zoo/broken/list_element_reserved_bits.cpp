// rule: list-element-reserved-bits
// names: getl
// twin: legal/list_element_size_16384
// Hides a flag of its own in the bits between the stall bit and the size.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[256];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 128, mfc_ea2l(argp)};
  list[1] = {0, 1, 128, mfc_ea2l(argp) + 4096};
  mfc_getl(buffer, argp, list, sizeof list, 5, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return 0;
}
