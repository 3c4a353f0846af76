// refused: immediate with low bits that the instruction drops
#include <spu_intrinsics.h>

qword f(qword a) { return si_lqd(a, 8); }
