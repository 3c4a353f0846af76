// rule: deadlock
// names: SPU_WrOutMbox
// twin: legal/mailbox_emptied
// Writes a second message to a mailbox of one place, and nobody takes the first.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  spu_write_out_mbox(1);
  spu_write_out_mbox(2);  // BROKEN
  return 0;
}
