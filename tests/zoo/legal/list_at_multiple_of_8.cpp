// keeps: list-address, list-size, ea-not-mapped, load-in-flight
// A list of two that begins in the middle of a quadword, and a wait before its bytes are read.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[64];
alignas(16) static mfc_list_element_t block[3];

int main(uint64_t, uint64_t argp, uint64_t) {
  block[1] = {0, 0, 128, mfc_ea2l(argp) + 4096};
  block[2] = {0, 0, 128, mfc_ea2l(argp)};
  mfc_getl(buffer, argp, &block[1], 2 * sizeof(mfc_list_element_t), 5, 0, 0);
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return buffer[0] == 1024 && buffer[32] == 0 ? 0 : 1;
}
