#include <spu_intrinsics.h>
#include <spu_mfcio.h>
void f(void* p, unsigned long long ea) { mfc_get(p, ea, 128, 3); }
