// refused: poisoned
#include <spu_intrinsics.h>

vec_float4 f(vec_float4 a) { return __builtin_shufflevector(a, a, 3, 2, 1, 0); }
