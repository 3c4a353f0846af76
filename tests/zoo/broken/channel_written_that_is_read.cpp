// rule: illegal-channel
// names: SPU_RdInMbox
// twin: legal/channels_in_their_direction
// Answers on the channel from which it reads its messages.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  spu_writech(SPU_RdInMbox, 1u);  // BROKEN
  return 0;
}
