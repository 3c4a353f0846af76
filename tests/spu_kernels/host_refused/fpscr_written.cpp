// refused: FPSCR is not modelled on the host
#include <spu_intrinsics.h>
void f(vec_uint4 a) { spu_mtfpscr(a); }
