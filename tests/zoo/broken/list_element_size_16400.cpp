// rule: list-element-size
// names: getl
// twin: legal/list_element_size_16384
// Relies on the 15 bits of an element's size, which reach to 32767; 16384 is the most.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128 + 16400];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 128, mfc_ea2l(argp)};
  list[1] = {0, 0, 16400, mfc_ea2l(argp)};
  mfc_getl(buffer, argp, list, sizeof list, 5, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return 0;
}
