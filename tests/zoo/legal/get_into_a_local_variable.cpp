// keeps: outside-objects, stack-overflow
// A transfer to the stack: legal while the function runs.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t argp, uint64_t) {
  alignas(16) uint32_t words[4];
  mfc_get(words, argp, sizeof words, 3, 0, 0);
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return words[3] == 3 ? 0 : 1;
}
