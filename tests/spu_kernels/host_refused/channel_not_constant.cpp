// refused: not a constant expression|no matching function for call to 'read_channel
#include <spu_intrinsics.h>
unsigned int f(int channel) { return spu_readch(channel); }
