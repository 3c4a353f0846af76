// refused: immintrin.h.*(No such file|file not found)
#include <immintrin.h>
#include <spu_intrinsics.h>

vec_float4 f(vec_float4 a) { return a; }
