// refused: static_cast.* (type|from|is not allowed)
#include <spu_intrinsics.h>

// Only a C cast keeps the bits of a vector.
vec_uint4 f(vec_float4 a) { return static_cast<vec_uint4>(a); }
