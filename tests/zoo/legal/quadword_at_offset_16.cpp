// keeps: lsa-alignment
// A quadword behind a header of 16 bytes.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(&buffer[4], argp + 32, 64, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return buffer[4] == 8 ? 0 : 1;
}
