// refused: a vector is no condition: write spu_sel\(b, a, mask\) for mask \? a : b, and ask for a lane with spu_extract\(\)
#include <spu_intrinsics.h>
vec_float4 f(vec_uint4 mask, vec_float4 a, vec_float4 b) { return mask ? a : b; }
