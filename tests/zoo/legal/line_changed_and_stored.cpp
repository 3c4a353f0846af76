// keeps: reservation-not-used
// A line that is changed and stored whatever others have done meanwhile.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[32];

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_getllar(line, envp, 0, 0);
  mfc_read_atomic_status();
  line[3] = 4;
  mfc_putlluc(line, envp, 0, 0);
  return mfc_read_atomic_status() == MFC_PUTLLUC_STATUS ? 0 : 1;
}
