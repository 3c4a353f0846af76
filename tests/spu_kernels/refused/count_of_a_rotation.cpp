// refused: no matching function for call to '?spu_rlmask
#include <spu_intrinsics.h>

// The counts that shift right are negative, so their vector is signed.
vec_uint4 f(vec_uint4 a, vec_uint4 count) { return spu_rlmask(a, count); }
