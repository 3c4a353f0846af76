// refused: multiples of 16 bytes
#include <spu_intrinsics.h>
qword f(qword a) { return si_lqd(a, 8); }
