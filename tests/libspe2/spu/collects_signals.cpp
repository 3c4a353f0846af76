// Register 1 collects bits (OR), register 2 keeps the last value. Ends with what both have: bits of 1 in the upper four
// bits, those of 2 below.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  spu_read_in_mbox();  // all signals were written
  const unsigned int collected = spu_read_signal1(), last = spu_read_signal2();
  return static_cast<int>((collected & 15u) << 4 | (last & 15u));
}
