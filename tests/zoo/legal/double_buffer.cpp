// keeps: load-in-flight, transfers-overlap
// Two buffers in turn: one is worked on while the other is fetched.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[2][32];

int main(uint64_t, uint64_t argp, uint64_t) {
  uint32_t sum = 0;
  mfc_get(buffer[0], argp, 128, 0, 0, 0);
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t next = (i + 1) % 2;
    if (i < 3) mfc_get(buffer[next], argp + 128 * (i + 1), 128, next, 0, 0);
    mfc_write_tag_mask(1u << (i % 2));
    mfc_read_tag_status_all();
    sum += buffer[i % 2][0];
  }
  return sum == 0 + 32 + 64 + 96 ? 0 : 1;
}
