// rule: list-crosses-4gb
// names: getl
// twin: legal/list_elements_share_their_high_half
// Gathers from a buffer on both sides of a boundary of 4 GB: all elements share one MFC_EAH.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[256];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 128, mfc_ea2l(argp)};
  list[1] = {0, 0, 128, 0xFFFFFFC0u};
  mfc_getl(buffer, argp, list, sizeof list, 5, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return 0;
}
