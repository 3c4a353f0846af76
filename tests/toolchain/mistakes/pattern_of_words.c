#include <spu_intrinsics.h>
#include <spu_mfcio.h>
vec_float4 f(vec_float4 a, vec_uint4 p) { return spu_shuffle(a, a, p); }
