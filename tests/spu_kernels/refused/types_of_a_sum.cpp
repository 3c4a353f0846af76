// refused: no matching function for call to '?spu_add
#include <spu_intrinsics.h>

vec_float4 f(vec_float4 a, vec_int4 b) { return spu_add(a, b); }
