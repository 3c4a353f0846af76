// sdk: check host
// The generic intrinsics that exist for all ten vector types.
#include "returns.h"
#include "vectors.h"

// TEST(vector, a value of it, the mask of its width, its lane)
// clang-format off
#define FOR_ALL(TEST) \
  TEST(vec_uchar16, u8,  u8,  unsigned char) \
  TEST(vec_char16,  s8,  u8,  signed char) \
  TEST(vec_ushort8, u16, u16, unsigned short) \
  TEST(vec_short8,  s16, u16, short) \
  TEST(vec_uint4,   u32, u32, unsigned int) \
  TEST(vec_int4,    s32, u32, int) \
  TEST(vec_ullong2, u64, u64, unsigned long long) \
  TEST(vec_llong2,  s64, u64, long long) \
  TEST(vec_float4,  f32, u32, float) \
  TEST(vec_double2, f64, u64, double)
// clang-format on

#define LOGIC(V, v, mask, S)       \
  RETURNS(V, spu_and(v, v));       \
  RETURNS(V, spu_or(v, v));        \
  RETURNS(V, spu_xor(v, v));       \
  RETURNS(V, spu_andc(v, v));      \
  RETURNS(V, spu_orc(v, v));       \
  RETURNS(V, spu_nand(v, v));      \
  RETURNS(V, spu_nor(v, v));       \
  RETURNS(V, spu_eqv(v, v));       \
  RETURNS(V, spu_sel(v, v, mask)); \
  RETURNS(V, spu_shuffle(v, v, u8));
FOR_ALL(LOGIC)

#define QUADWORD(V, v, mask, S)       \
  RETURNS(V, spu_slqw(v, 3));         \
  RETURNS(V, spu_slqwbyte(v, u));     \
  RETURNS(V, spu_slqwbytebc(v, u));   \
  RETURNS(V, spu_srqw(v, 3));         \
  RETURNS(V, spu_srqwbyte(v, u));     \
  RETURNS(V, spu_srqwbytebc(v, u));   \
  RETURNS(V, spu_rlqw(v, 3));         \
  RETURNS(V, spu_rlqwbyte(v, i));     \
  RETURNS(V, spu_rlqwbytebc(v, i));   \
  RETURNS(V, spu_rlmaskqw(v, -3));    \
  RETURNS(V, spu_rlmaskqwbyte(v, i)); \
  RETURNS(V, spu_rlmaskqwbytebc(v, i));
FOR_ALL(QUADWORD)

#define LANES(V, v, mask, S)                       \
  RETURNS(V, spu_splats(static_cast<S>(1)));       \
  RETURNS(V, spu_promote(static_cast<S>(1), i));   \
  RETURNS(V, spu_insert(static_cast<S>(1), v, i)); \
  RETURNS(S, spu_extract(v, 1));
FOR_ALL(LANES)

RETURNS(vec_int4, spu_splats(1));
RETURNS(vec_uint4, spu_splats(1u));
RETURNS(vec_float4, spu_splats(1.0f));
RETURNS(vec_double2, spu_splats(1.0));
RETURNS(vec_ullong2, spu_splats(1ull));
