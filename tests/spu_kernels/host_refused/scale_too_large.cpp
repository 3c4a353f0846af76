// refused: scale from 0 to 127
#include <spu_intrinsics.h>
vec_int4 f(vec_float4 a) { return spu_convts(a, 128); }
