#pragma once
// Positions and normals of four vertices to what is drawn: halves, a quadword to a vertex.

#include <spu_intrinsics.h>

#include "common/half.h"
#include "common/reciprocal.h"
#include "common/vector3.h"

namespace softcell::spu {

/// Whether positions need the conversion that knows every case.
enum class Positions {
  kOrdinary,  ///< all between kOrdinaryLeast and kOrdinaryMost
  kAny
};

/// Corners between these make ordinary positions: rounding in the cell's polynomial moves a position by less
/// than 2^-18 of the largest corner, which leaves it positive and a normal half. Metres: the PPU side puts
/// the origin below a body by a 16th of its size, so bodies of 1.6 cm to 60 m are ordinary.
constexpr float kOrdinaryLeast = 0x1p-10f, kOrdinaryMost = 0x1p6f;

/// Adds to `odd` the sign bits of components that are not ordinary.
inline vec_uint4 note_odd(vec_uint4 odd, vec_float4 corner) {
  const vec_float4 below = spu_sub(corner, spu_splats(kOrdinaryLeast));
  const vec_float4 above = spu_sub(spu_splats(kOrdinaryMost), corner);
  return spu_or(odd, (vec_uint4)spu_or(below, above));
}

/// Halves of one vector of each vertex, as pairs of its components: x0 y0 x1 y1 .. and z0 w0 z1 w1 ..
struct HalfVectors {
  vec_ushort8 xy, zw;
};

/// The high halves of words: of a word of `a`, then of the same word of `b`. Words become halfwords before
/// they are shuffled, which costs nothing here; afterwards a host would have to swap halves.
inline vec_ushort8 pack(vec_uint4 a, vec_uint4 b) {
  const vec_uchar16 high_halves = {0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29};
  return spu_shuffle((vec_ushort8)a, (vec_ushort8)b, high_halves);
}

/// Positions, the fourth component 1.
template <Positions kPositions>
inline HalfVectors half_positions(const Vector3x4& v) {
  const vec_uint4 one = spu_splats(0x3C000000u);
  if constexpr (kPositions == Positions::kOrdinary) {
    return {pack(high_half_of_positive(v.x), high_half_of_positive(v.y)),
            pack(high_half_of_positive(v.z), one)};
  } else {
    const vec_float4 zero = spu_splats(0.0f);  // takes the sign from zeros, as in high_half_of_rebiased()
    return {pack(high_half_of_any(spu_add(v.x, zero)), high_half_of_any(spu_add(v.y, zero))),
            pack(high_half_of_any(spu_add(v.z, zero)), one)};
  }
}

/// Vectors of any length brought to unit length, the fourth component 0. Rebiasing is part of that in a cell
/// of ordinary size, where a vector is no longer than 2^14 (the product of two diagonals) and its reciprocal,
/// rebiased, a normal float.
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

/// Transposes the 4 x 4 pairs: a vertex to a quadword.
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
