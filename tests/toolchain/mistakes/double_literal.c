#include <spu_intrinsics.h>
#include <spu_mfcio.h>
vec_float4 f(vec_float4 a) { return spu_mul(a, spu_splats(2.0)); }
