// keeps: deadlock
// ppu: out_mbox=3
// Three messages through a mailbox of one place, which the PPU empties.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  spu_write_out_mbox(1);
  spu_write_out_mbox(2);
  spu_write_out_mbox(3);
  return 0;
}
