// refused: could not convert|cannot convert|no viable conversion|no match
#include <spu_intrinsics.h>
vec_float4 f() { return 1.0f; }
