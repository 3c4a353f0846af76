#include <spu_intrinsics.h>
#include <spu_mfcio.h>
vec_uint4 f(vec_float4 a) { return a; }
