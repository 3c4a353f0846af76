// refused: special purpose registers are not modelled on the host
#include <spu_intrinsics.h>
unsigned int f() { return spu_mfspr(0); }
