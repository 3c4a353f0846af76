// keeps: deadline-exceeded
// Polls a few times and gives up.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  for (int i = 0; i < 1000; ++i) {
    if (spu_stat_in_mbox() != 0) return 1;
  }
  return 0;
}
