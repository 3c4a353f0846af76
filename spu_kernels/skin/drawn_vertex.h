#pragma once
// Converts positions and normals of four vertices to the format in which they are drawn: half floats, one quadword for each vertex.

#include <spu_intrinsics.h>

#include "common/half.h"
#include "common/reciprocal.h"
#include "common/vector3.h"

namespace softcell::spu {

/// Which conversion positions need: the fast one, or the one for every bit pattern.
enum class Positions {
  kOrdinary,  ///< all between kOrdinaryLeast and kOrdinaryMost
  kAny
};

/// Metres: from corners with components in this range, positions are ordinary. Rounding in the cell's polynomial moves a position by less
/// than 2^-18 of the largest corner, so it stays positive and a normal half. The PPU side puts
/// the origin below a body by a sixteenth of its size, so bodies of 1.6 cm to 60 m are ordinary.
constexpr float kOrdinaryLeast = 0x1p-10f, kOrdinaryMost = 0x1p6f;

/// Adds to `odd` the sign bits of components that are not ordinary.
inline vec_uint4 note_odd(vec_uint4 odd, vec_float4 corner) {
  const vec_float4 below = spu_sub(corner, spu_splats(kOrdinaryLeast));
  const vec_float4 above = spu_sub(spu_splats(kOrdinaryMost), corner);
  return spu_or(odd, (vec_uint4)spu_or(below, above));
}

/// One vector of each of four vertices as halves, in pairs of components: x0 y0 x1 y1 .. and z0 w0 z1 w1 ..
struct HalfVectors {
  vec_ushort8 xy, zw;
};

/// The high halves of words: of a word of `a`, then of the same word of `b`. The words are cast to halfwords before
/// the shuffle, which costs nothing; after it a host would have to swap halves.
inline vec_ushort8 pack(vec_uint4 a, vec_uint4 b) {
  const vec_uchar16 high_halves = {0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29};
  return spu_shuffle((vec_ushort8)a, (vec_ushort8)b, high_halves);
}

/// Converts positions; the fourth component is 1.
template <Positions kPositions>
inline HalfVectors half_positions(const Vector3x4& v) {
  const vec_uint4 one = spu_splats(0x3C000000u);
  if constexpr (kPositions == Positions::kOrdinary) {
    return {pack(high_half_of_positive(v.x), high_half_of_positive(v.y)),
            pack(high_half_of_positive(v.z), one)};
  } else {
    const vec_float4 zero = spu_splats(0.0f);  // makes +0 of -0, as in high_half_of_rebiased()
    return {pack(high_half_of_any(spu_add(v.x, zero)), high_half_of_any(spu_add(v.y, zero))),
            pack(high_half_of_any(spu_add(v.z, zero)), one)};
  }
}

/// Converts vectors of any length to unit vectors; the fourth component is 0. In a cell of ordinary size the same multiplication also
/// rebiases: there a vector is no longer than 2^14 (the product of two diagonals), so that its rebiased reciprocal is a normal float.
template <Positions kPositions>
inline HalfVectors half_normals(const Vector3x4& v) {
  const vec_float4 squared = dot(v, v);
  if constexpr (kPositions == Positions::kOrdinary) {
    const Vector3x4 unit = scale(v, rough_reciprocal_sqrt(squared, kHalfRebias));
    return {pack(high_half_of_rebiased(unit.x), high_half_of_rebiased(unit.y)),
            pack(high_half_of_rebiased(unit.z), spu_splats(0u))};
  } else {
    const Vector3x4 unit = scale(v, rough_reciprocal_sqrt(squared));
    return {pack(high_half_or_zero(unit.x), high_half_or_zero(unit.y)),
            pack(high_half_or_zero(unit.z), spu_splats(0u))};
  }
}

/// Transposes the 4 x 4 pairs and stores one quadword for each vertex.
inline void store(const HalfVectors& position, const HalfVectors& normal, vec_ushort8* out) {
  const vec_uchar16 low = {0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23};
  const vec_uchar16 high = {8, 9, 10, 11, 24, 25, 26, 27, 12, 13, 14, 15, 28, 29, 30, 31};
  const vec_ushort8 a = spu_shuffle(position.xy, normal.xy, low);
  const vec_ushort8 b = spu_shuffle(position.xy, normal.xy, high);
  const vec_ushort8 c = spu_shuffle(position.zw, normal.zw, low);
  const vec_ushort8 d = spu_shuffle(position.zw, normal.zw, high);
  out[0] = spu_shuffle(a, c, low);
  out[1] = spu_shuffle(a, c, high);
  out[2] = spu_shuffle(b, d, low);
  out[3] = spu_shuffle(b, d, high);
}

}  // namespace softcell::spu
