// keeps: illegal-instruction
// Every case ends in an answer.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static volatile uint32_t kind = 3;

int main(uint64_t, uint64_t, uint64_t) {
  switch (kind) {
    case 1:
    case 2:
      return 1;
    default:
      return 0;
  }
}
