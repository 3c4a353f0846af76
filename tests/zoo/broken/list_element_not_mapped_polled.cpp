// rule: ea-not-mapped
// names: getl
// twin: legal/list_at_multiple_of_8
// One element of the list was never filled in, and the program only ever looks at a channel's count: on the
// hardware the answer never comes.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 64, mfc_ea2l(argp)};
  list[1] = {0, 0, 64, 0};
  mfc_getl(buffer, argp, list, sizeof list, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_write_tag_update_all();
  while (mfc_stat_tag_status() == 0) {
  }
  mfc_read_tag_status();
  return 0;
}
