// keeps: ea-crosses-buffer
// The last 128 bytes of a buffer, by a command and by a list.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t block[64];
alignas(8) static mfc_list_element_t list[1];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 128, mfc_ea2l(argp) + 65536 - 128};
  mfc_get(&block[0], argp + 65536 - 128, 128, 0, 0, 0);
  mfc_getl(&block[32], argp, list, sizeof list, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return block[31] == 16383 && block[63] == 16383 ? 0 : 1;
}
