// keeps: list-size
// The longest list: 2048 elements of 8 bytes, each of which begins a quadword of its own.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[2048 * 4];
alignas(8) static mfc_list_element_t list[2048];

int main(uint64_t, uint64_t argp, uint64_t) {
  for (unsigned int i = 0; i < 2048; ++i) list[i] = {0, 0, 8, mfc_ea2l(argp) + 16 * i};
  mfc_getl(buffer, argp, list, sizeof list, 5, 0, 0);
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return buffer[2047 * 4 + 1] == 2047 * 4 + 1 ? 0 : 1;
}
