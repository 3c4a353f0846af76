// rule: signal-command
// names: sndsig
// twin: legal/signal_to_its_own_register
// Sends a signal to a word of main storage: that would be a put.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static uint32_t word[4] = {0, 0, 0, 1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_sndsig(&word[3], envp + 12, 1, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 1);
  mfc_read_tag_status_all();
  return 0;
}
