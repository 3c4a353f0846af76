// rule: list-in-flight
// names: getl
// twin: legal/list_patched_behind_a_stall
// build: checked
// Builds its next list where the last one is still being read by the MFC.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[256];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 128, mfc_ea2l(argp)};
  list[1] = {0, 0, 128, mfc_ea2l(argp) + 4096};
  mfc_getl(buffer, argp, list, sizeof list, 5, 0, 0);
  list[1].eal = mfc_ea2l(argp) + 8192;  // BROKEN
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return 0;
}
