// refused: not a constant expression|not usable in a constant expression
// The compiler itself takes it, and calculates the scale when the kernel runs; others do not.
#include <spu_intrinsics.h>

vec_float4 f(vec_int4 a, int scale) { return spu_convtf(a, scale); }
