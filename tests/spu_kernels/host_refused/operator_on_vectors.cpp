// refused: no match for .operator\+|invalid operands
#include <spu_intrinsics.h>
vec_float4 f(vec_float4 a, vec_uint4 b) { return a + b; }
