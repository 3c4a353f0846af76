// refused: no matching function for call to '?spu_cmpgt
#include <spu_intrinsics.h>

vec_ullong2 f(vec_ullong2 a, vec_ullong2 b) { return spu_cmpgt(a, b); }
