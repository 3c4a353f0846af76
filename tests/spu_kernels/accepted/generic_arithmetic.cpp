// sdk: check host
// Arithmetic, comparisons, conversions and shifts: the types that the language extensions list for each.
#include "returns.h"
#include "vectors.h"

#define FOR_16_32(TEST)            \
  TEST(vec_ushort8, u16, u16, s16) \
  TEST(vec_short8, s16, u16, s16) TEST(vec_uint4, u32, u32, s32) TEST(vec_int4, s32, u32, s32)
#define SUMS_AND_SHIFTS(V, v, shift, turn) \
  RETURNS(V, spu_add(v, v));               \
  RETURNS(V, spu_add(v, 1));               \
  RETURNS(V, spu_sub(v, v));               \
  RETURNS(V, spu_sub(0, v));               \
  RETURNS(V, spu_sl(v, shift));            \
  RETURNS(V, spu_sl(v, 3));                \
  RETURNS(V, spu_sr(v, shift));            \
  RETURNS(V, spu_sr(v, u));                \
  RETURNS(V, spu_sra(v, shift));           \
  RETURNS(V, spu_sra(v, 3));               \
  RETURNS(V, spu_rl(v, turn));             \
  RETURNS(V, spu_rl(v, i));                \
  RETURNS(V, spu_rlmask(v, turn));         \
  RETURNS(V, spu_rlmask(v, -3));           \
  RETURNS(V, spu_rlmaska(v, turn));        \
  RETURNS(V, spu_rlmaska(v, i));
FOR_16_32(SUMS_AND_SHIFTS)

#define CARRIES(V, v)             \
  RETURNS(V, spu_addx(v, v, v));  \
  RETURNS(V, spu_subx(v, v, v));  \
  RETURNS(V, spu_genc(v, v));     \
  RETURNS(V, spu_gencx(v, v, v)); \
  RETURNS(V, spu_genb(v, v));     \
  RETURNS(V, spu_genbx(v, v, v)); \
  RETURNS(V, spu_orx(v));         \
  RETURNS(vec_uint4, spu_cntlz(v));
CARRIES(vec_uint4, u32)
CARRIES(vec_int4, s32)

#define REALS(V, v)              \
  RETURNS(V, spu_add(v, v));     \
  RETURNS(V, spu_sub(v, v));     \
  RETURNS(V, spu_mul(v, v));     \
  RETURNS(V, spu_madd(v, v, v)); \
  RETURNS(V, spu_msub(v, v, v)); \
  RETURNS(V, spu_nmsub(v, v, v));
REALS(vec_float4, f32)
REALS(vec_double2, f64)
RETURNS(vec_double2, spu_nmadd(f64, f64, f64));
RETURNS(vec_float4, spu_re(f32));
RETURNS(vec_float4, spu_rsqrte(f32));

RETURNS(vec_int4, spu_madd(s16, s16, s32));
RETURNS(vec_int4, spu_mule(s16, s16));
RETURNS(vec_uint4, spu_mule(u16, u16));
RETURNS(vec_int4, spu_mulo(s16, s16));
RETURNS(vec_uint4, spu_mulo(u16, u16));
RETURNS(vec_int4, spu_mulo(s16, 3));
RETURNS(vec_uint4, spu_mulo(u16, 3));
RETURNS(vec_int4, spu_mulh(s16, s16));
RETURNS(vec_int4, spu_mulsr(s16, s16));
RETURNS(vec_int4, spu_mhhadd(s16, s16, s32));
RETURNS(vec_uint4, spu_mhhadd(u16, u16, u32));

RETURNS(vec_uchar16, spu_absd(u8, u8));
RETURNS(vec_uchar16, spu_avg(u8, u8));
RETURNS(vec_ushort8, spu_sumb(u8, u8));
RETURNS(vec_uchar16, spu_cntb(s8));
RETURNS(vec_uint4, spu_cntlz(f32));

#define COMPARE(U, v)          \
  RETURNS(U, spu_cmpeq(v, v)); \
  RETURNS(U, spu_cmpgt(v, v));
#define COMPARE_INTEGERS(U, v) \
  COMPARE(U, v)                \
  RETURNS(U, spu_cmpeq(v, 1)); \
  RETURNS(U, spu_cmpgt(v, 1)); \
  RETURNS(vec_uint4, spu_gather(v));
COMPARE_INTEGERS(vec_uchar16, u8)
COMPARE_INTEGERS(vec_uchar16, s8)
COMPARE_INTEGERS(vec_ushort8, u16)
COMPARE_INTEGERS(vec_ushort8, s16)
COMPARE_INTEGERS(vec_uint4, u32)
COMPARE_INTEGERS(vec_uint4, s32)
COMPARE(vec_uint4, f32)
RETURNS(vec_uint4, spu_cmpabseq(f32, f32));
RETURNS(vec_uint4, spu_cmpabsgt(f32, f32));
RETURNS(vec_uint4, spu_gather(f32));

RETURNS(vec_uchar16, spu_maskb(0x1234));
RETURNS(vec_ushort8, spu_maskh(0x12u));
RETURNS(vec_uint4, spu_maskw(u));

RETURNS(vec_float4, spu_convtf(s32, 0));
RETURNS(vec_float4, spu_convtf(u32, 127));
RETURNS(vec_int4, spu_convts(f32, 16));
RETURNS(vec_uint4, spu_convtu(f32, 16));
RETURNS(vec_short8, spu_extend(s8));
RETURNS(vec_int4, spu_extend(s16));
RETURNS(vec_llong2, spu_extend(s32));
RETURNS(vec_double2, spu_extend(f32));
RETURNS(vec_float4, spu_roundtf(f64));

// Scalar operands of logic; a literal with commas in parentheses; casts keep the bits.
RETURNS(vec_ushort8, spu_and(u16, 0xFF));
RETURNS(vec_int4, spu_or(s32, 1));
RETURNS(vec_uchar16, spu_xor(u8, 0x80));
RETURNS(vec_uint4, spu_add(u32, ((vec_uint4){0u, 1u, 2u, 3u})));
RETURNS(vec_uint4, spu_and((vec_uint4)f32, 0x7FFFFFFFu));
