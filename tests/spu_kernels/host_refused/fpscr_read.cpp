// refused: FPSCR is not modelled on the host
#include <spu_intrinsics.h>
vec_uint4 f() { return spu_mffpscr(); }
