// rule: illegal-channel
// names: MFC_WrTagMask
// twin: legal/channels_in_their_direction
// Reads back the tag mask from the channel to which it is written; MFC_RdTagMask is for that.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  mfc_write_tag_mask(1u << 3);
  return spu_readch(MFC_WrTagMask) == 8 ? 0 : 1;  // BROKEN
}
