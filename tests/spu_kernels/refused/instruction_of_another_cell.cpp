// refused: si_dfceq
#include <spu_intrinsics.h>

// Double-precision comparisons are the PowerXCell's.
qword f(qword a) { return si_dfceq(a, a); }
