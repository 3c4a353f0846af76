// refused: immediate with low bits that the instruction drops
// The compiler itself takes it, and drops the low bits without a word.
#include <spu_intrinsics.h>

qword f(qword a) { return si_lqd(a, 8); }
