// keeps: transfers-overlap
// A line that is put, and after the wait for its tag looked at and changed.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t values[32] = {1}, line[32];

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(values, envp, sizeof values, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  do {
    mfc_getllar(line, envp, 0, 0);
    mfc_read_atomic_status();
    line[1] = line[0] + 1;
    mfc_putllc(line, envp, 0, 0);
  } while ((mfc_read_atomic_status() & MFC_PUTLLC_STATUS) != 0);
  return line[1] == 2 ? 0 : 1;
}
