// keeps: tag-update-condition
// Asks at once, again and again, until the tag is complete.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  while (mfc_read_tag_status_immediate() == 0) {
  }
  return buffer[1] == 1 ? 0 : 1;
}
