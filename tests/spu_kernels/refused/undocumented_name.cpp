// refused: spu_div
#include <spu_intrinsics.h>

vec_float4 f(vec_float4 a) { return spu_div(a, a); }
