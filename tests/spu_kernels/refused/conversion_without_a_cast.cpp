// refused: cannot (convert|initialize).*unsigned int
#include <spu_intrinsics.h>

vec_int4 f(vec_uint4 a) { return a; }
