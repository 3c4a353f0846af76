// keeps: unknown-command, proxy-form-only
// The result form of put, which is a hint: the same bytes move.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32] = {7};

int main(uint64_t, uint64_t, uint64_t envp) {
  spu_mfcdma64(buffer, mfc_ea2h(envp), mfc_ea2l(envp), 128, 0, MFC_PUTR_CMD);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  mfc_get(buffer, envp, sizeof buffer, 0, 0, 0);
  mfc_read_tag_status_all();
  return buffer[0] == 7 ? 0 : 1;
}
