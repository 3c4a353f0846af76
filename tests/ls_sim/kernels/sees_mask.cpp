// Ends with 1 when the event mask that it begins with has anything in it, with 2 when its tag mask has.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  if (spu_read_event_mask() != 0) return 1;
  return mfc_read_tag_mask() != 0 ? 2 : 0;
}
