// rule: unknown-command
// names: opcode 0xA4
// twin: legal/put_with_result
// Wants to send several signals by one list: sndsig has no list form.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  spu_mfcdma64(buffer, mfc_ea2h(argp), mfc_ea2l(argp), 8, 0, MFC_SNDSIG_CMD | MFC_LIST_ENABLE);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
