#include <spu_intrinsics.h>
#include "help.h"
void scale(float* numbers, unsigned count) {
  vec_float4* vectors = reinterpret_cast<vec_float4*>(numbers);
  for (unsigned i = 0; i < count / 4; ++i)
    vectors[i] = spu_mul(vectors[i], spu_splats(static_cast<float>(FACTOR)));
}
