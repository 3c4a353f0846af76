// refused: interrupts are not modelled on the host
#include <spu_intrinsics.h>
void f() { spu_ienable(); }
