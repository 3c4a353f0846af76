// refused: invalid conversion from .*const|cannot initialize a parameter of type 'volatile void
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static const float table[4] = {1, 2, 3, 4};
void f(uint64_t ea) { mfc_put(table, ea, sizeof table, 0, 0, 0); }
