// refused: deleted function
#include <spu_intrinsics.h>

// Of two scalars the first must be an int or an unsigned int.
void f(long a) { spu_hcmpeq(a, 0); }
