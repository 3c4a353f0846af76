// keeps: list-element-alignment
// Words gathered from anywhere: each keeps its place in a quadword, and each begins a new one.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[12];
alignas(8) static mfc_list_element_t list[3];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 4, mfc_ea2l(argp) + 4};
  list[1] = {0, 0, 4, mfc_ea2l(argp) + 40};
  list[2] = {0, 0, 4, mfc_ea2l(argp) + 12};
  mfc_getl(buffer, argp, list, sizeof list, 5, 0, 0);
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return buffer[1] == 1 && buffer[4 + 2] == 10 && buffer[8 + 3] == 3 ? 0 : 1;
}
