// keeps: list-stall-ack-tag, list-stalled-for-ever
// A list that stalls once: its bit is read, and the tag's number is acknowledged.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[64];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {1, 0, 128, mfc_ea2l(argp)};
  list[1] = {0, 0, 128, mfc_ea2l(argp) + 128};
  mfc_getl(buffer, argp, list, sizeof list, 5, 0, 0);
  if (mfc_read_list_stall_status() != 1u << 5) return 1;
  mfc_write_list_stall_ack(5);
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return buffer[32] == 32 ? 0 : 2;
}
