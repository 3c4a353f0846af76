// keeps: load-in-flight, store-in-flight
// Waits for its tag, then reads and writes what it has fetched.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  buffer[0] += buffer[31];
  return buffer[0] == 31 ? 0 : 1;
}
