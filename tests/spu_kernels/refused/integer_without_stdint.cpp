// refused: uint32_t
#include <spu_intrinsics.h>

// Only spu_mfcio.h includes stdint.h.
uint32_t f() { return 0; }
