// refused: could not convert|cannot convert|no viable conversion
#include <spu_intrinsics.h>
vec_uint4 f(vec_float4 a) { return a; }
