#pragma once
// The rotation nearest to a 2x2 matrix, for four regions at a time, in closed form.
//
//   R = argmax <R, A>:  (cos, sin) = (C, S) / |(C, S)|,   C = A11 + A22,  S = A21 - A12
//
// This is the optimum for every A, of rank 2 or 1, with either sign of the determinant. If C = S = 0, for a point or an exact mirror image,
// all rotations are equally good, and the direction of the last step stays.

#include <spu_intrinsics.h>

#include "common/reciprocal.h"
#include "common/unit_scale.h"
#include "common/vector2.h"

namespace softcell::spu {

/// Cosine and sine of a rotation's angle.
struct Direction4 {
  vec_float4 cosine, sine;
};

/// to + R v, and from - R v; each component is rounded twice.
inline Vector2x4 add_turned(const Vector2x4& to, const Direction4& r, const Vector2x4& v) {
  return {spu_nmsub(r.sine, v.y, spu_madd(r.cosine, v.x, to.x)),
          spu_madd(r.sine, v.x, spu_madd(r.cosine, v.y, to.y))};
}
inline Vector2x4 subtract_turned(const Vector2x4& from, const Direction4& r, const Vector2x4& v) {
  return {spu_madd(r.sine, v.y, spu_nmsub(r.cosine, v.x, from.x)),
          spu_nmsub(r.sine, v.x, spu_nmsub(r.cosine, v.y, from.y))};
}

/// (C, S) / |(C, S)|; its length is one to within two roundings.
/// @param c, s   finite; if |C| + |S| is not in 1e-37..1.7e38, it is noise
/// @param kept   the result where |C| + |S| is noise
__attribute__((always_inline)) inline Direction4 direction_of(vec_float4 c, vec_float4 s,
                                                              const RotationNoise& noise_of,
                                                              const Direction4& kept) {
  const UnitScale unit = unit_scale(spu_add(absolute(c), absolute(s)), noise_of);
  const Vector2x4 v = {spu_mul(c, unit.by), spu_mul(s, unit.by)};
  const Vector2x4 u = scale(v, reciprocal_sqrt(dot(v, v)));
  // The length is one to within 5e-6; a further step of Newton's method corrects it.
  const vec_float4 half = spu_splats(0.5f);
  const vec_float4 missing = spu_nmsub(spu_mul(half, u.x), u.x, spu_nmsub(spu_mul(half, u.y), u.y, half));
  const Vector2x4 d = scale_add(u, missing, u);
  return {spu_sel(d.x, kept.cosine, unit.noise), spu_sel(d.y, kept.sine, unit.noise)};
}

}  // namespace softcell::spu
