// refused: cannot convert|cannot initialize a parameter
#include <spu_intrinsics.h>

qword f(vec_float4 a) { return si_fa(a, a); }
