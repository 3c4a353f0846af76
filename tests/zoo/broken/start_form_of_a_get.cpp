// rule: proxy-form-only
// names: gets
// twin: legal/put_with_result
// Wants to fetch the program for another SPU and start it in one command: gets is the PPU's.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  spu_mfcdma64(buffer, mfc_ea2h(argp), mfc_ea2l(argp), 128, 0, MFC_GET_CMD | 0x08);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
