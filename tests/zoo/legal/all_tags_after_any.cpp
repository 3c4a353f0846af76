// keeps: tag-without-command
// Works on what has arrived as soon as any of two gets has, then waits for both: the first wait promises one of them only.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t first[32], second[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(first, argp, sizeof first, 3, 0, 0);
  mfc_get(second, argp + 128, sizeof second, 4, 0, 0);
  mfc_write_tag_mask(1u << 3 | 1u << 4);
  mfc_read_tag_status_any();
  mfc_read_tag_status_all();
  return first[0] == second[0] + 1 ? 1 : 0;
}
