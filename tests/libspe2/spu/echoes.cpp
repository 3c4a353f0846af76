// Answers each value of its mailbox: v + 1 through the outbound one, v * 2 through the interrupting one. 0 ends it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  unsigned int served = 0;
  for (;;) {
    const unsigned int value = spu_read_in_mbox();
    if (value == 0) return static_cast<int>(served);
    spu_write_out_mbox(value + 1);
    spu_write_out_intr_mbox(value * 2);
    ++served;
  }
}
