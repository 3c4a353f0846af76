// rule: stack-overflow
// twin: legal/stack_within_its_declaration
// Fetches into a local array that is larger than the whole declared stack of 4 KB.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t argp, uint64_t) {
  alignas(16) unsigned char rows[8192];
  mfc_get(rows, argp, sizeof rows, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
