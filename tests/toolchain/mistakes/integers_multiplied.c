#include <spu_intrinsics.h>
#include <spu_mfcio.h>
vec_int4 f(vec_int4 a, vec_int4 b, vec_int4 c) { return spu_madd(a, b, c); }
