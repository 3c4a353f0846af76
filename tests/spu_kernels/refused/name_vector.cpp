// refused: expected unqualified-id
#include <spu_intrinsics.h>

// With -std=c++17 the word is a macro on the SPU.
int vector = 0;
