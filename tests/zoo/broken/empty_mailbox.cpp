// rule: deadlock
// names: SPU_RdInMbox
// twin: legal/mailbox_answered
// Reads its mailbox, into which nobody writes.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  return static_cast<int>(spu_read_in_mbox());  // BROKEN
}
