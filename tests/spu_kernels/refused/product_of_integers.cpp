// refused: no matching function for call to '?spu_mul
#include <spu_intrinsics.h>

// Words have no product; halves have spu_mulo and spu_mule.
vec_int4 f(vec_int4 a, vec_int4 b) { return spu_mul(a, b); }
