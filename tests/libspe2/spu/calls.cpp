// Has the PPU side add numbers: call 16, operation 7, { a, b } -> { a + b, calls so far }.
#include <spu_intrinsics.h>
#include <stdint.h>
#include <sys/send_to_ppe.h>

int main(uint64_t, uint64_t, uint64_t) {
  alignas(16) volatile unsigned int arguments[4];
  unsigned int sum = 0;
  for (unsigned int i = 1; i <= 10; ++i) {
    arguments[0] = sum;
    arguments[1] = i;
    arguments[2] = arguments[3] = 0;
    __send_to_ppe(0x2110, 7, const_cast<unsigned int*>(arguments));
    sum = arguments[0];
    if (arguments[1] != i) return 255;
  }
  return static_cast<int>(sum);
}
