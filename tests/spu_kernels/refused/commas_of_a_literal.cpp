// refused: macro .?spu_add.? passed 5 arguments|too many arguments provided to function-like macro
#include <spu_intrinsics.h>

vec_float4 f(vec_float4 a) { return spu_add(a, (vec_float4){0.0f, 1.0f, 2.0f, 3.0f}); }
