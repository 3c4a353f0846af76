// A kernel of somebody who is warned of an unused variable.
#include <spu_intrinsics.h>
#include <stdint.h>

int main(uint64_t, uint64_t, uint64_t) {
  int unused = 1;
  return 42;
}
