// refused: no matching function for call to '?spu_shuffle
#include <spu_intrinsics.h>

vec_float4 f(vec_float4 a, vec_uint4 pattern) { return spu_shuffle(a, a, pattern); }
