// refused: _mm_add_ps
#include <spu_intrinsics.h>

vec_float4 f(vec_float4 a) { return _mm_add_ps(a, a); }
