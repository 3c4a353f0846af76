// keeps: illegal-channel
// Writes the mask by one channel and reads it back by the other.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  spu_writech(MFC_WrTagMask, 8u);
  spu_write_event_mask(MFC_SIGNAL_NOTIFY_1_EVENT);
  return spu_readch(MFC_RdTagMask) == 8 && spu_read_event_mask() == MFC_SIGNAL_NOTIFY_1_EVENT ? 0 : 1;
}
