#include <spu_intrinsics.h>
#include <spu_mfcio.h>
vec_float4 f(vec_float4 a, vec_int4 b) { return spu_add(a, b); }
