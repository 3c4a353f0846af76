// keeps: register-access
// envp: next-spe
// Four bytes to the second signal register by a plain put.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static uint32_t word[4] = {0, 0, 0, 6};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(&word[3], envp + 0x5C00C, 4, 1, 0, 0);
  mfc_write_tag_mask(1u << 1);
  mfc_read_tag_status_all();
  return spu_read_signal2() == 6 ? 0 : 1;
}
