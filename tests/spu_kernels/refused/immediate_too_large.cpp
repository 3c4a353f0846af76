// refused: immediate outside the range of its field
#include <spu_intrinsics.h>

qword f(qword a) { return si_ai(a, 512); }
