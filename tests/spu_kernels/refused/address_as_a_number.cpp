// refused: invalid conversion from 'int' to|cannot initialize a parameter of type 'volatile void
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

// Local store is addressed by pointers to objects.
void f(uint64_t ea) { mfc_get(0x1000, ea, 128, 0, 0, 0); }
