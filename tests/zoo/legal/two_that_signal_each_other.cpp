// keeps: deadlock
// envp: next-spe
// spes: 2
// Runs on two SPEs: each signals the other before it waits.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static uint32_t word[4] = {0, 0, 0, 1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_sndsig(&word[3], envp + 0x5400C, 1, 0, 0);
  mfc_write_tag_mask(1u << 1);
  mfc_read_tag_status_all();
  return spu_read_signal1() == 1 ? 0 : 1;
}
