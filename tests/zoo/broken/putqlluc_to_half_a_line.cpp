// rule: atomic-alignment
// names: putqlluc
// twin: legal/putqlluc_waits_for_its_tag
// Stores a line in the middle of two.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[32] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_putqlluc(line, envp + 64, 2, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 2);
  mfc_read_tag_status_all();
  return 0;
}
