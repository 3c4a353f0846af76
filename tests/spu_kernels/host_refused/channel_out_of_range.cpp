// refused: channels are numbered 0 to 127
#include <spu_intrinsics.h>
void f() { spu_writech(128, 0u); }
