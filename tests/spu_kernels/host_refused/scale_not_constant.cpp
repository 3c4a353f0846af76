// refused: not a constant expression|no matching function for call to 'to_float
#include <spu_intrinsics.h>
vec_float4 f(vec_int4 a, unsigned int scale) { return spu_convtf(a, scale); }
