// refused: a stop code has 14 bits
#include <spu_intrinsics.h>
void f() { spu_stop(0x4000); }
