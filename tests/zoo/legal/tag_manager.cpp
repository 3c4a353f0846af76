// keeps: tag-out-of-range
// A tag from the tag manager, tested before its use and given back.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t buffer[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  const unsigned int tag = mfc_tag_reserve();
  if (tag == MFC_TAG_INVALID) return 1;
  mfc_get(buffer, argp, sizeof buffer, tag, 0, 0);
  mfc_write_tag_mask(1u << tag);
  mfc_read_tag_status_all();
  return mfc_tag_release(tag) == MFC_TAG_VALID && buffer[1] == 1 ? 0 : 2;
}
