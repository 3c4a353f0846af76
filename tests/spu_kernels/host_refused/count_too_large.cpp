// refused: immediate does not hold that value
#include <spu_intrinsics.h>
qword f(qword a) { return si_shli(a, 128); }
