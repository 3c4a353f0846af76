// rule: list-size
// names: getl
// twin: legal/list_of_2048
// Gathers one more than the 2048 elements that a list has at most.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[2049 * 16];
alignas(8) static mfc_list_element_t list[2049];

int main(uint64_t, uint64_t argp, uint64_t) {
  for (unsigned int i = 0; i < 2049; ++i) list[i] = {0, 0, 16, mfc_ea2l(argp) + 16 * i};
  mfc_getl(buffer, argp, list, sizeof list, 5, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return 0;
}
