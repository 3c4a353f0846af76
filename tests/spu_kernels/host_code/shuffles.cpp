// Constant patterns must cost nothing: the comment above each function says how many instructions it may
// take, its return not counted.
#include <spu_intrinsics.h>

// instructions: 1
extern "C" vec_float4 splat_word(vec_float4 a) {
  return spu_shuffle(a, a, ((vec_uchar16){4, 5, 6, 7, 4, 5, 6, 7, 4, 5, 6, 7, 4, 5, 6, 7}));
}
// instructions: 1
extern "C" vec_uint4 merge_high(vec_uint4 a, vec_uint4 b) {
  return spu_shuffle(a, b, ((vec_uchar16){0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23}));
}
// instructions: 2
extern "C" vec_ushort8 swap_halves(vec_ushort8 a) {
  return spu_shuffle(a, a, ((vec_uchar16){2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13}));
}
// instructions: 1
extern "C" vec_float4 next_word(vec_float4 a) { return spu_rlqwbyte(a, 4); }
// instructions: 3
extern "C" vec_uchar16 any_bytes(vec_uchar16 a, vec_uchar16 b) {
  return spu_shuffle(a, b, ((vec_uchar16){31, 2, 3, 16, 9, 18, 4, 1, 14, 30, 7, 22, 23, 0, 5, 8}));
}
// instructions: 5
extern "C" vec_uint4 with_constants(vec_uint4 a, vec_uint4 b) {
  return spu_shuffle(
      a, b, ((vec_uchar16){0, 1, 2, 3, 0x80, 0x80, 0x80, 0x80, 16, 17, 18, 19, 0xC0, 0xC0, 0xC0, 0xC0}));
}
// A cast between lane widths is one permutation, between equal ones none.
// instructions: 1
extern "C" vec_uchar16 bytes_of_words(vec_uint4 a) { return (vec_uchar16)a; }
// instructions: 0
extern "C" vec_uint4 words_of_floats(vec_float4 a) { return (vec_uint4)a; }
// Arithmetic is one instruction; a product needs its zero.
// instructions: 1
extern "C" vec_float4 fused(vec_float4 a, vec_float4 b, vec_float4 c) { return spu_madd(a, b, c); }
// instructions: 2
extern "C" vec_float4 product(vec_float4 a, vec_float4 b) { return spu_mul(a, b); }
// instructions: 1
extern "C" vec_uint4 shifted(vec_uint4 a) { return spu_rlmask(a, -13); }
