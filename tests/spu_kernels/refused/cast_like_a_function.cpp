// refused: expected (primary-)?expression
#include <spu_intrinsics.h>

vec_uint4 f(vec_float4 a) { return vec_uint4(a); }
