#include <spu_intrinsics.h>

extern "C" vector unsigned int sums(unsigned int count) {
  vector unsigned int sum = spu_splats(0u);
  for (unsigned int i = 1; i <= count; ++i) sum += spu_splats(i);
  return sum;
}
