#pragma once
// One value of each type, for calls that are only looked at.

#include <spu_intrinsics.h>

extern vec_uchar16 u8;
extern vec_char16 s8;
extern vec_ushort8 u16;
extern vec_short8 s16;
extern vec_uint4 u32;
extern vec_int4 s32;
extern vec_ullong2 u64;
extern vec_llong2 s64;
extern vec_float4 f32;
extern vec_double2 f64;
extern qword q;

extern int i;
extern unsigned int u;
