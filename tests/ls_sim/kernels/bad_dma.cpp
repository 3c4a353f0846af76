// One DMA command that breaks the rule of sizes: envp bytes to an aligned buffer.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t envp) {
  mfc_get(buffer, argp, static_cast<uint32_t>(envp), 3, 0, 0);
  mfc_write_tag_mask(8);
  mfc_read_tag_status_all();
  return 0;
}
