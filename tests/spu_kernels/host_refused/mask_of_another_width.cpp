// refused: no form for operands
#include <spu_intrinsics.h>
vec_float4 f(vec_float4 a, vec_uchar16 mask) { return spu_sel(a, a, mask); }
