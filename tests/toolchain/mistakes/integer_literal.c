#include <spu_intrinsics.h>
#include <spu_mfcio.h>
vec_float4 f(vec_float4 a) { return spu_add(a, spu_splats(1)); }
