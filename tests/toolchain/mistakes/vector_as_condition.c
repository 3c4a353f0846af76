#include <spu_intrinsics.h>
#include <spu_mfcio.h>
int f(vec_float4 a, vec_float4 b) { if (spu_cmpgt(a, b)) return 1; return 0; }
