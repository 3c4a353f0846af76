/* Fails as its second argument says: 1 divides the smallest integer by -1, 2 calls a null pointer, 3 reads by one, 4 reads a vector
 * that is not aligned, 5 reads from the third argument, an address of main storage, and 6 writes there. */
#include <limits.h>
#include <spu_intrinsics.h>

static volatile int numerator = INT_MIN, divisor = -1;
static int (*volatile function)(void);
static volatile int* volatile place;
static float floats[8] __attribute__((aligned(16)));
static const float* volatile unaligned = floats + 1;
static volatile vec_float4 loaded;

int main(unsigned long long spe, unsigned long long how, unsigned long long ea) {
  (void)spe;
  if (how == 1) return numerator / divisor;
  if (how == 2) return function() + 1;
  if (how == 4) {
    loaded = *(const vec_float4*)unaligned;
    return 0;
  }
  if (how == 5) return *(volatile int*)(unsigned int)ea;
  if (how == 6) *(volatile int*)(unsigned int)ea = 1;
  return *place;
}
