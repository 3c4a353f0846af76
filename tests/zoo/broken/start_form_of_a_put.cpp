// rule: proxy-form-only
// names: puts
// twin: legal/put_with_result
// Uses the form that starts an SPU when the data are there: only the PPU can give it, on the proxy queue.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  spu_mfcdma64(buffer, mfc_ea2h(envp), mfc_ea2l(envp), 128, 0, MFC_PUT_CMD | 0x08);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
