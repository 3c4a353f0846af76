// Compiling this is the test: the data model of kernels is the SPU's.
#include <spu_intrinsics.h>
#include <stdint.h>

#ifdef __cplusplus
#define SC_ASSERT_SAME static_assert
#else
#define SC_ASSERT_SAME _Static_assert
#endif
#define SC_LAYOUT(type, size, alignment)                       \
  SC_ASSERT_SAME(sizeof(type) == (size), "size of " #type);    \
  SC_ASSERT_SAME(__alignof__(type) == (alignment), "alignment of " #type);
#define SC_OFFSET(type, member, offset) \
  SC_ASSERT_SAME(__builtin_offsetof(type, member) == (offset), "offset of " #type "::" #member);

#include "structures.h"
