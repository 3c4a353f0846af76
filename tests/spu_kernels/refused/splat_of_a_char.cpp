// refused: deleted function
#include <spu_intrinsics.h>

// Plain char is neither the signed nor the unsigned one.
vec_uchar16 f() { return spu_splats('x'); }
