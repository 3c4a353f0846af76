// keeps: tag-out-of-range
// The last tag.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 31, 0, 0);
  mfc_write_tag_mask(1u << 31);
  mfc_read_tag_status_all();
  return buffer[31] == 31 ? 0 : 1;
}
