// refused: cmath.*(No such file|file not found)
#include <spu_intrinsics.h>
#include <cmath>

vec_float4 f(vec_float4 a) { return a; }
