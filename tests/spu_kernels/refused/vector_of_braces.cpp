// refused: expected (primary-)?expression
#include <spu_intrinsics.h>

vec_float4 f() { return vec_float4{0.0f, 1.0f, 2.0f, 3.0f}; }
