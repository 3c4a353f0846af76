// keeps: ea-not-mapped
// An effective address taken apart and put together again, both halves of it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  const uint64_t address = mfc_hl2ea(mfc_ea2h(argp), mfc_ea2l(argp)) + 128;
  mfc_get(buffer, address, sizeof buffer, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return buffer[0] == 32 ? 0 : 1;
}
