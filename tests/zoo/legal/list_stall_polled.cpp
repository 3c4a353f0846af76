// keeps: list-stall-not-expected
// A list without stall bits: the count says that there is nothing to read.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32];
alignas(8) static mfc_list_element_t list[1];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 128, mfc_ea2l(argp)};
  mfc_getl(buffer, argp, list, sizeof list, 5, 0, 0);
  if (mfc_stat_list_stall_status() != 0) mfc_write_list_stall_ack(mfc_read_list_stall_status());
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return buffer[1] == 1 ? 0 : 1;
}
