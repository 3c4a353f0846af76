// refused: not a constant expression|not usable in a constant expression
#include <spu_intrinsics.h>

unsigned int f(int channel) { return spu_readch(channel); }
