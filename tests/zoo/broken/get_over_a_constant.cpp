// rule: write-to-code
// names: get
// twin: legal/constant_read
// build: checked
// Fetches settings over the constants that stand for them.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static const uint32_t settings[4] = {1, 2, 3, 4};

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(const_cast<uint32_t*>(settings), argp, 16, 3, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return 0;
}
