/* Answers mailboxes until it gets 0; stops once with a code of its own. */
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(void) {
  unsigned int value, sum = 0;
  while ((value = spu_read_in_mbox()) != 0) {
    sum += value;
    spu_write_out_mbox(value * 2);
    if (value == 3) spu_stop(0x123);
    if (value == 5) spu_write_out_intr_mbox(sum);
  }
  spu_write_out_mbox(spu_read_signal1());
  return 4;
}
