// rule: register-access
// names: put
// twin: legal/put_to_a_signal_register
// envp: next-spe
// Puts a quadword over a signal register, which takes exactly four bytes.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static uint32_t word[4] = {0, 0, 0, 1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(word, envp + 0x54000, 16, 1, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 1);
  mfc_read_tag_status_all();
  return 0;
}
