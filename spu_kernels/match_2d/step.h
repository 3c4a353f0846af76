#pragma once
// One body's step in local store: matching, then damping. It changes velocities, not positions.
//
//   first             second             (the two buffers, slot by slot)
//   particles   -->   bars
//   regions     <--                      sums become motions in place
//               -->   bars
//   totals      <--                      goals and new velocities; drift and spin are subtracted
//   particles   ...                      the same again for damping

#include "common/sums.h"
#include "match_2d/damping.h"
#include "match_2d/local_store.h"
#include "match_2d/matching.h"

namespace softcell::spu {

/// Sums from particles to regions, both in `first`.
inline void sum_up(const PlanMap2d& plan) {
  sum_slots<1>(plan.bars_of_particles, plan.first, plan.second);
  sum_slots<1>(plan.regions_of_bars, plan.second, plan.first);
}

/// Sums from regions to totals: the sums over all regions of which a particle is a member. Membership is symmetric, so the lists are the
/// same as in sum_up(), except the first.
inline void sum_down(const PlanMap2d& plan) {
  sum_slots<1>(plan.bars_of_regions, plan.first, plan.second);
  sum_slots<1>(plan.regions_of_bars, plan.second, plan.first);
}

/// Sums over particles, with d = g - x. Each lane has the sum over its own particles.
struct PullSums {
  Vector2x4 moved;     ///< m d
  Vector2x4 moment;    ///< m x
  vec_float4 turned;   ///< m x x d
  vec_float4 inertia;  ///< m |x|^2
};

/// Changes velocities by the totals: v += pull (g - x).
inline PullSums pull_particles(const PlanMap2d& plan, const BodyMap2d& body, vec_float4 pull) {
  const vec_float4 zero = spu_splats(0.0f);
  PullSums sums = {{zero, zero}, {zero, zero}, zero, zero};
  for (uint32_t g = 0; g < plan.particle_groups; ++g) {
    const ParticleConstants2d& p = plan.particles[g];
    const Vector2x4 x = body.positions[g], d = to_goals(p, plan.first, x), moment = scale(x, p.mass);
    body.velocities[g] = scale_add(d, pull, body.velocities[g]);
    sums.moved = scale_add(d, p.mass, sums.moved);
    sums.moment = sum(sums.moment, moment);
    sums.turned = spu_nmsub(moment.y, d.x, spu_madd(moment.x, d.y, sums.turned));
    sums.inertia = spu_madd(moment.x, x.x, spu_madd(moment.y, x.y, sums.inertia));
  }
  return sums;
}

/// Subtracts from the velocities the motion that the pull has given the body as a whole: b + omega (-y, x). It is only a rounding error,
/// but truncation always errs in the same direction, so a body at rest would begin to drift and to spin.
inline void hold_momenta(const PlanMap2d& plan, const BodyMap2d& body, const PullSums& sums,
                         vec_float4 pull) {
  const vec_float4 by = spu_splats(plan.inverse_mass);
  const Vector2x4 centre = scale(Vector2x4{sum_of_lanes(sums.moment.x), sum_of_lanes(sums.moment.y)}, by);
  const Vector2x4 drift = scale(Vector2x4{sum_of_lanes(sums.moved.x), sum_of_lanes(sums.moved.y)}, by);
  const vec_float4 inertia = spu_msub(sum_of_lanes(sums.inertia), by, dot(centre, centre));
  const vec_float4 spin = spu_msub(sum_of_lanes(sums.turned), by, cross(centre, drift));
  const vec_float4 omega = spu_mul(pull, angular_velocity(spin, inertia, spu_splats(plan.noise_floor)));
  const Vector2x4 b = {spu_madd(omega, centre.y, spu_mul(pull, drift.x)),
                       spu_msub(pull, drift.y, spu_mul(omega, centre.x))};
  for (uint32_t g = 0; g < plan.particle_groups; ++g) {
    const Vector2x4 v = difference(body.velocities[g], b), x = body.positions[g];
    body.velocities[g] = {spu_madd(omega, x.y, v.x), spu_nmsub(omega, x.x, v.y)};
  }
}

inline void match_body(const PlanMap2d& plan, const BodyMap2d& body, float pull) {
  for (uint32_t g = 0; g < plan.particle_groups; ++g)
    match_moments(plan.particles[g], body.positions[g], plan.first + 1 + 4 * g);
  sum_up(plan);
  for (uint32_t g = 0; g < plan.region_groups; ++g)
    match_regions(plan.regions[g], plan.first + 1 + 4 * g, spu_splats(plan.noise_floor), body.directions[g],
                  plan.centres[g]);
  sum_down(plan);
  hold_momenta(plan, body, pull_particles(plan, body, spu_splats(pull)), spu_splats(pull));
}

/// @pre  match_body() has computed the centres of the regions
inline void damp_body(const PlanMap2d& plan, const BodyMap2d& body, float damping) {
  for (uint32_t g = 0; g < plan.particle_groups; ++g)
    twist_moments(plan.particles[g], body.positions[g], body.velocities[g], plan.first + 1 + 4 * g);
  sum_up(plan);
  for (uint32_t g = 0; g < plan.region_groups; ++g)
    twist_regions(plan.regions[g], plan.centres[g], plan.first + 1 + 4 * g, spu_splats(plan.noise_floor));
  sum_down(plan);
  for (uint32_t g = 0; g < plan.particle_groups; ++g)
    body.velocities[g] =
        damp(plan.particles[g], plan.first, body.positions[g], body.velocities[g], spu_splats(damping));
}

/// @pre  positions and velocities are in components, positions relative to the body's origin; slot 0 of both buffers is zero
inline void step_body(const PlanMap2d& plan, const BodyMap2d& body, float pull, float damping) {
  match_body(plan, body, pull);
  if (damping > 0) damp_body(plan, body, damping);
}

}  // namespace softcell::spu
