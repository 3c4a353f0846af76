#pragma once
// Vectors of constants, and of one constant in all lanes; static data may begin with them.
// [SDK for Multicore Acceleration, vec_literal.h] second-hand

#include <spu_intrinsics.h>

#define VEC_LITERAL(type, ...) ((type){__VA_ARGS__})

#define SC_TWICE(...) __VA_ARGS__, __VA_ARGS__
#define VEC_SPLAT_U8(value) ((vec_uchar16){SC_TWICE(value, value, value, value, value, value, value, value)})
#define VEC_SPLAT_S8(value) ((vec_char16){SC_TWICE(value, value, value, value, value, value, value, value)})
#define VEC_SPLAT_U16(value) ((vec_ushort8){SC_TWICE(value, value, value, value)})
#define VEC_SPLAT_S16(value) ((vec_short8){SC_TWICE(value, value, value, value)})
#define VEC_SPLAT_U32(value) ((vec_uint4){SC_TWICE(value, value)})
#define VEC_SPLAT_S32(value) ((vec_int4){SC_TWICE(value, value)})
#define VEC_SPLAT_F32(value) ((vec_float4){SC_TWICE(value, value)})
#define VEC_SPLAT_U64(value) ((vec_ullong2){SC_TWICE(value)})
#define VEC_SPLAT_S64(value) ((vec_llong2){SC_TWICE(value)})
#define VEC_SPLAT_F64(value) ((vec_double2){SC_TWICE(value)})
