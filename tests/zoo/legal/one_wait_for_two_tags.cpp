// keeps: commands-outstanding, tag-without-command
// One wait for both of its tags.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t results[64] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(&results[0], envp, 128, 0, 0, 0);
  mfc_put(&results[32], envp + 128, 128, 1, 0, 0);
  mfc_write_tag_mask(1u << 0 | 1u << 1);
  mfc_read_tag_status_all();
  return 0;
}
