// refused: no matching function
#include <spu_intrinsics.h>
vec_uint4 f() { return (vec_uint4)spu_splats(true); }
