// rule: low-bits-differ
// names: sndsig
// twin: legal/signal_to_its_own_register
// envp: next-spe
// Sends a signal from the first word of a quadword: the registers' addresses end in 0xC, and so must the
// local one.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static uint32_t word[4] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_sndsig(&word[0], envp + 0x5400C, 1, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 1);
  mfc_read_tag_status_all();
  return 0;
}
