// rule: illegal-channel
// names: channel 5
// twin: legal/channels_in_their_direction
// Reads channel 5, which no SPU has.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  return static_cast<int>(spu_readch(5));  // BROKEN
}
