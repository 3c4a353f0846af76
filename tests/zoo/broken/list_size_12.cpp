// rule: list-size
// names: getl
// twin: legal/list_of_2048
// Gives the size of one and a half elements: it counted words, three of them.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[256];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 128, mfc_ea2l(argp)};
  list[1] = {0, 0, 128, mfc_ea2l(argp) + 4096};
  mfc_getl(buffer, argp, list, 3 * sizeof(uint32_t), 5, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return 0;
}
