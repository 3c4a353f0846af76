// refused: request for member|member reference base type
#include <spu_intrinsics.h>

// The host's vectors are classes; the SPU's are not.
auto f(vec_float4 a) { return a.raw; }
