// keeps: tag-mask-empty
// An empty mask asked at once: no tag, and no wait.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  mfc_write_tag_mask(0);
  return mfc_read_tag_status_immediate() == 0 ? 0 : 1;
}
