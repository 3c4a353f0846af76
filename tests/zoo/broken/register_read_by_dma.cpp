// rule: register-access
// names: get
// twin: legal/put_to_a_signal_register
// envp: next-spe
// Looks by DMA whether a signal has arrived; the register cannot be read so.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static uint32_t word[4];

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_get(&word[3], envp + 0x5400C, 4, 1, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 1);
  mfc_read_tag_status_all();
  return 0;
}
