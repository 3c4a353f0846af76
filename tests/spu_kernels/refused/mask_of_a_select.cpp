// refused: no matching function for call to '?spu_sel
#include <spu_intrinsics.h>

vec_float4 f(vec_float4 a, vec_float4 b, vec_int4 mask) { return spu_sel(a, b, mask); }
