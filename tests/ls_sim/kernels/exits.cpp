// Stops with the code 0x123 instead of returning from main.
#include <spu_intrinsics.h>
#include <stdint.h>

int main(uint64_t, uint64_t, uint64_t) {
  spu_stop(0x123);
  return 0;
}
