// keeps: ea-not-mapped
// envp: next-spe
// Puts into the free part of the next SPE's local store, by its effective address, and fetches it back.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32] = {9}, back[32];

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(buffer, envp + 0x30000, sizeof buffer, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  mfc_get(back, envp + 0x30000, sizeof back, 0, 0, 0);
  mfc_read_tag_status_all();
  return back[0] == 9 ? 0 : 1;
}
