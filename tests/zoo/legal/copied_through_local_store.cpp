// keeps: effective-address-as-pointer
// Fetches what an address leads to, and reads the copy.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  const uint32_t* const data = buffer;
  return data[2] == 2 ? 0 : 1;
}
