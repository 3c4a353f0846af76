// rule: list-stall-ack-tag
// names: MFC_WrListStallAck
// twin: legal/list_stall_acknowledged
// Acknowledges in advance, before any list has stalled.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[256];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {1, 0, 128, mfc_ea2l(argp)};
  list[1] = {0, 0, 128, mfc_ea2l(argp) + 4096};
  mfc_write_list_stall_ack(5);  // BROKEN
  mfc_getl(buffer, argp, list, sizeof list, 5, 0, 0);
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return 0;
}
