// refused: immediate outside the range of its field
#include <spu_intrinsics.h>

vec_float4 f(vec_int4 a) { return spu_convtf(a, 128); }
