#pragma once
// The arithmetic of region damping between the sums: the payload of a particle, the rigid motion of a region, and what becomes of the sums
// of motions.
// [Mueller et al. 2006, section 3.5, per region]
//
//   up      (m~v, m~ x x v, m~ |x|^2)                            of a particle
//   region  omega = (L - c x P) / (I - M |c|^2),  b = P / M + omega (cy, -cx)
//   down    (b, omega, 0)
//   dv      1 / |R_i|  (sum b + (sum omega) (-y, x)) - v

#include <spu_intrinsics.h>

#include "common/lane_mask.h"
#include "common/reciprocal.h"
#include "match_2d/matching.h"

namespace softcell::spu {

/// Computes the payload of four particles.
inline void twist_moments(const ParticleConstants2d& p, const Vector2x4& x, const Vector2x4& v, Slot2d* out) {
  const Vector2x4 momentum = scale(v, p.modified_mass);
  store_slots(out, {momentum.x, momentum.y, cross(x, momentum), spu_mul(p.modified_mass, dot(x, x))});
}

/// Angular momentum over moment of inertia, both per mass.
/// @param noise_floor  inertias up to this are noise: particles on one point do not turn
inline vec_float4 angular_velocity(vec_float4 momentum, vec_float4 inertia, vec_float4 noise_floor) {
  const vec_uint4 turns = negative_lanes(less(noise_floor, inertia));
  return (vec_float4)spu_and((vec_uint4)spu_mul(momentum, reciprocal(inertia)), turns);
}

/// Computes the twists of four regions from their sums, in place.
/// @param centre  from match_regions()
inline void twist_regions(const RegionConstants2d& r, const Vector2x4& centre, Slot2d* slots,
                          vec_float4 noise_floor) {
  const Rows4 sums = load_slots(slots);
  const Vector2x4 velocity = scale(Vector2x4{sums.a, sums.b}, r.inverse_mass);
  const vec_float4 inertia = spu_msub(sums.d, r.inverse_mass, dot(centre, centre));
  const vec_float4 momentum = spu_msub(sums.c, r.inverse_mass, cross(centre, velocity));
  const vec_float4 omega = angular_velocity(momentum, inertia, noise_floor);
  store_slots(slots, {spu_madd(omega, centre.y, velocity.x), spu_nmsub(omega, centre.x, velocity.y), omega,
                      spu_splats(0.0f)});
}

/// The velocities of four particles, minus `damping` times the part that is not the rigid motion of their regions.
inline Vector2x4 damp(const ParticleConstants2d& p, const Slot2d* totals, const Vector2x4& x,
                      const Vector2x4& v, vec_float4 damping) {
  const Rows4 sum = load_totals(p, totals);
  const Vector2x4 rigid = {spu_nmsub(sum.c, x.y, sum.a), spu_madd(sum.c, x.x, sum.b)};
  return scale_add({spu_msub(rigid.x, p.share, v.x), spu_msub(rigid.y, p.share, v.y)}, damping, v);
}

}  // namespace softcell::spu
