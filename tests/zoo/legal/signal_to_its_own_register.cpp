// keeps: signal-command, low-bits-differ
// envp: next-spe
// A signal from a word whose address ends in 0xC, as that of the register does.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static uint32_t word[4] = {0, 0, 0, 6};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_sndsig(&word[3], envp + 0x5400C, 1, 0, 0);
  mfc_write_tag_mask(1u << 1);
  mfc_read_tag_status_all();
  return spu_read_signal1() == 6 ? 0 : 1;
}
