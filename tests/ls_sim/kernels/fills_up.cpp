// Fills its local store to just below where the job loop has its stack; ends with the last byte as it finds
// it, and leaves a 7 there.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static volatile unsigned char bulk[0x3ECC0 - 0x80 - 0x80];

int main(uint64_t, uint64_t, uint64_t) {
  const int before = bulk[sizeof bulk - 1];
  bulk[sizeof bulk - 1] = 7;
  return before;
}
