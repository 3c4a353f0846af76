// keeps: size-zero
// An element of size 0: in a list it stands for nothing to move.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 0, mfc_ea2l(argp)};
  list[1] = {0, 0, 128, mfc_ea2l(argp) + 128};
  mfc_getl(buffer, argp, list, sizeof list, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return buffer[0] == 32 ? 0 : 1;
}
