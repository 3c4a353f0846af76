// keeps: list-element-size, list-element-reserved-bits
// Two elements of 16384 bytes, the most that one has; the bits above the size are zero.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[2 * 4096];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 16384, mfc_ea2l(argp) + 16384};
  list[1] = {0, 0, 16384, mfc_ea2l(argp)};
  mfc_getl(buffer, argp, list, sizeof list, 5, 0, 0);
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return buffer[0] == 4096 && buffer[4096] == 0 ? 0 : 1;
}
