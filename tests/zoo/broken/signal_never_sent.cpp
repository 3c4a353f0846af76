// rule: deadlock
// names: SPU_RdSigNotify2
// twin: legal/signal_from_the_ppu
// Waits at the second signal register; whoever knows of it writes to the first.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  return static_cast<int>(spu_read_signal2());  // BROKEN
}
