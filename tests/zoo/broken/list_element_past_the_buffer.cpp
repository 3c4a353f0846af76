// rule: ea-crosses-buffer
// names: getl
// twin: legal/last_bytes_of_buffer
// Gathers rows of a table by a list whose last row is longer than what is left.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[256];
alignas(8) static mfc_list_element_t list[1];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 256, mfc_ea2l(argp) + 65536 - 128};
  mfc_getl(buffer, argp, list, sizeof list, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
