// refused: no matching function
#include <spu_intrinsics.h>
vec_uint4 f(vec_uint4 a) { return spu_mul(a, a); }
