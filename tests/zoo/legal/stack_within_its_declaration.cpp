// keeps: stack-overflow
// A local array that fits the declared stack of 4 KB.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t argp, uint64_t) {
  alignas(16) uint32_t rows[512];
  mfc_get(rows, argp, sizeof rows, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return rows[511] == 511 ? 0 : 1;
}
