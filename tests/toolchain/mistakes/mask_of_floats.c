#include <spu_intrinsics.h>
#include <spu_mfcio.h>
vec_float4 f(vec_float4 a, vec_float4 b) { return spu_sel(a, b, a); }
