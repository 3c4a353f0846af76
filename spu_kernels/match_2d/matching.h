#pragma once
// The arithmetic of shape matching between the sums: the payload of a particle, the best rigid motion of a region, and the goals.  [LSM07]
//
//   up      (m~x, m~y, m~ x.x0, m~ x0 x x)                       of a particle
//   region  c = P / M,  C = sum3 - P.c0,  S = sum4 - c0 x P,  (cos, sin) = (C, S) / |(C, S)|,  t = c - R c0
//   down    (t, cos, sin)
//   goal    g = 1 / |R_i|  (sum t + (sum R) x0)

#include <spu_intrinsics.h>

#include "common/sums.h"
#include "common/transpose.h"
#include "match_2d/local_store.h"

namespace softcell::spu {

/// Four adjacent slots, transposed: one component of all four slots in each register.
inline Rows4 load_slots(const Slot2d* slots) {
  return transpose({slots[0].row[0], slots[1].row[0], slots[2].row[0], slots[3].row[0]});
}

inline void store_slots(Slot2d* slots, const Rows4& components) {
  const Rows4 t = transpose(components);
  slots[0].row[0] = t.a;
  slots[1].row[0] = t.b;
  slots[2].row[0] = t.c;
  slots[3].row[0] = t.d;
}

/// The totals of the regions of four particles.
inline Rows4 load_totals(const ParticleConstants2d& p, const Slot2d* totals) {
  return transpose({slot_at(totals, p.region[0]).row[0], slot_at(totals, p.region[1]).row[0],
                    slot_at(totals, p.region[2]).row[0], slot_at(totals, p.region[3]).row[0]});
}

/// Computes the payload of four particles.
inline void match_moments(const ParticleConstants2d& p, const Vector2x4& x, Slot2d* out) {
  const Vector2x4 moment = scale(x, p.modified_mass);
  store_slots(out, {moment.x, moment.y, dot(moment, p.rest), cross(p.rest, moment)});
}

/// Computes the motions of four regions from their sums, in place.
/// @param direction  in: of the last step; out: of this step
/// @param centre     out: c
inline void match_regions(const RegionConstants2d& r, Slot2d* slots, vec_float4 noise_floor,
                          Direction4& direction, Vector2x4& centre) {
  const Rows4 sums = load_slots(slots);
  const Vector2x4 momentum = {sums.a, sums.b};
  const vec_float4 c = spu_nmsub(momentum.x, r.centre.x, spu_nmsub(momentum.y, r.centre.y, sums.c));
  const vec_float4 s = spu_nmsub(r.centre.x, momentum.y, spu_madd(r.centre.y, momentum.x, sums.d));
  direction = direction_of(c, s, {r.inverse_mass, noise_floor}, direction);
  centre = scale(momentum, r.inverse_mass);
  const Vector2x4 t = subtract_turned(centre, direction, r.centre);
  store_slots(slots, {t.x, t.y, direction.cosine, direction.sine});
}

/// g - x of four particles. The goal g is not rounded by itself, so that particles at their goals stay there.
inline Vector2x4 to_goals(const ParticleConstants2d& p, const Slot2d* totals, const Vector2x4& x) {
  const Rows4 sum = load_totals(p, totals);
  const Vector2x4 goals = add_turned({sum.a, sum.b}, {sum.c, sum.d}, p.rest);
  return {spu_msub(goals.x, p.share, x.x), spu_msub(goals.y, p.share, x.y)};
}

}  // namespace softcell::spu
