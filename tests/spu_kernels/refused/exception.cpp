// refused: exception
#include <spu_intrinsics.h>

void f() { throw 1; }
