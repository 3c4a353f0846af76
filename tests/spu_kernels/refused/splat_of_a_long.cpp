// refused: deleted function
#include <spu_intrinsics.h>

// A long has no vector type: int and long long have.
vec_int4 f(long a) { return spu_splats(a); }
