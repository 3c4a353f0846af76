#include <spu_intrinsics.h>
#include <spu_mfcio.h>
vec_float4 f(vec_float4 a) { return spu_mul(a, 2.0f); }
