// refused: no form for operands
#include <spu_intrinsics.h>
vec_uint4 f(vec_uint4 a) { return spu_mul(a, a); }
