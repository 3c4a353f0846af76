#pragma once
// The vector types by the names of VMX. [LEXT, data types] documented

#include <spu_intrinsics.h>

/* What comparisons give, and pixels. */
#define vec_bchar16 vec_uchar16
#define vec_bshort8 vec_ushort8
#define vec_pixel8 vec_ushort8
#define vec_bint4 vec_uint4
