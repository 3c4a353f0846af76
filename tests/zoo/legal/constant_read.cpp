// keeps: write-to-code
// Constants are read, and copied to where they may be changed.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static const uint32_t table[4] = {1, 2, 3, 4};
static volatile uint32_t copy[4];

int main(uint64_t, uint64_t, uint64_t) {
  for (uint32_t i = 0; i < 4; ++i) copy[i] = table[i];
  copy[1] = 5;
  return copy[1] == 5 && table[1] == 2 ? 0 : 1;
}
