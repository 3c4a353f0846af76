#pragma once
// Converts between records of four words and structures of arrays.

#include <spu_intrinsics.h>

namespace softcell::spu {

/// Four quadwords: the rows of a 4 x 4 matrix of floats.
struct Rows4 {
  vec_float4 a, b, c, d;
};

/// Words 0 and 1 of both: x0 y0 x1 y1.
inline vec_float4 interleave_low(vec_float4 x, vec_float4 y) {
  const vec_uchar16 low = {0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23};
  return spu_shuffle(x, y, low);
}

/// Words 2 and 3 of both: x2 y2 x3 y3.
inline vec_float4 interleave_high(vec_float4 x, vec_float4 y) {
  const vec_uchar16 high = {8, 9, 10, 11, 24, 25, 26, 27, 12, 13, 14, 15, 28, 29, 30, 31};
  return spu_shuffle(x, y, high);
}

/// Row i of the result is column i of the argument.
inline Rows4 transpose(const Rows4& m) {
  const vec_float4 ac_low = interleave_low(m.a, m.c), ac_high = interleave_high(m.a, m.c);
  const vec_float4 bd_low = interleave_low(m.b, m.d), bd_high = interleave_high(m.b, m.d);
  return {interleave_low(ac_low, bd_low), interleave_high(ac_low, bd_low), interleave_low(ac_high, bd_high),
          interleave_high(ac_high, bd_high)};
}

/// The sum of the words of each row: of a in word 0, of b in word 1, ...
inline vec_float4 sums_of_rows(const Rows4& m) {
  const vec_float4 ac = spu_add(interleave_low(m.a, m.c), interleave_high(m.a, m.c));  // a02 c02 a13 c13
  const vec_float4 bd = spu_add(interleave_low(m.b, m.d), interleave_high(m.b, m.d));
  return spu_add(interleave_low(ac, bd), interleave_high(ac, bd));
}

/// The sum of the four words, in all of them.
inline vec_float4 sum_of_lanes(vec_float4 v) {
  const vec_uchar16 halves = {8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7};
  const vec_uchar16 neighbours = {4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11};
  const vec_float4 pairs = spu_add(v, spu_shuffle(v, v, halves));
  return spu_add(pairs, spu_shuffle(pairs, pairs, neighbours));
}

}  // namespace softcell::spu
