// keeps: list-crosses-4gb
// Elements in two buffers: the high half of the address is the same for all.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[64];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t envp) {
  if (mfc_ea2h(argp) != mfc_ea2h(envp)) return 1;
  list[0] = {0, 0, 128, mfc_ea2l(envp)};
  list[1] = {0, 0, 128, mfc_ea2l(argp) + 128};
  mfc_getl(buffer, argp, list, sizeof list, 5, 0, 0);
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return buffer[0] == 0 && buffer[32] == 32 ? 0 : 1;
}
