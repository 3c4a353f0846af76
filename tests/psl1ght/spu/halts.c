/* Halts when it gets 1; waits for ever otherwise. */
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(void) {
  for (;;) spu_hcmpeq(spu_read_in_mbox(), 1);
}
