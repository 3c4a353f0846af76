// rule: illegal-instruction
// twin: legal/every_case_handled
// Has a case that "cannot happen", and it does.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static volatile uint32_t kind = 3;

int main(uint64_t, uint64_t, uint64_t) {
  switch (kind) {
    case 1:
    case 2:
      return 0;
    default:
      __builtin_trap();  // BROKEN
  }
}
