// Serves the PPU side: reads numbers from its mailbox and answers each with its double, until it reads 0.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  for (;;) {
    const uint32_t value = spu_read_in_mbox();
    if (value == 0) return 0;
    spu_write_out_mbox(2 * value);
  }
}
