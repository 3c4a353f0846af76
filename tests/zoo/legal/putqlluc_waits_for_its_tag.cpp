// keeps: atomic-alignment, atomic-status-not-expected
// The queued line command: it has a tag, and no status.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[32] = {5};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_putqlluc(line, envp, 2, 0, 0);
  mfc_write_tag_mask(1u << 2);
  mfc_read_tag_status_all();
  mfc_get(line, envp, sizeof line, 2, 0, 0);
  mfc_read_tag_status_all();
  return line[0] == 5 ? 0 : 1;
}
