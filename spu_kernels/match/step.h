#pragma once
// One body's step in local store: matching, then damping. It changes velocities, not positions.
//
//   first             second             (the two buffers, slot by slot)
//   particles   -->   bars
//   plates      <--
//               -->   regions: sums become motions in place
//   bars        <--
//               -->   plates
//   totals      <--                      goals and new velocities; the drift is subtracted (hold.h)
//               -->   particles          the same again for damping, with the buffers exchanged

#include "common/sums.h"
#include "match/damping.h"
#include "match/hold.h"
#include "match/local_store.h"
#include "match/localise.h"
#include "match/matching.h"

namespace softcell::spu {

/// Sums from particles in `a` to regions in `b`.
inline void sum_up(const BodyMap& map, Slot* a, Slot* b) {
  sum_slots<3>(map.bars_of_particles, a, b);
  sum_slots<3>(map.plates, b, a);
  sum_slots<3>(map.regions_of_plates, a, b);
}

/// Sums from regions in `b` to totals in `a`: the sums over all regions of which a particle is a member. Membership is symmetric, so the
/// lists are the same as in sum_up(), except the first.
template <int kRows>
inline void sum_down(const BodyMap& map, Slot* b, Slot* a) {
  sum_slots<kRows>(map.bars_of_regions, b, a);
  sum_slots<kRows>(map.plates, a, b);
  sum_slots<kRows>(map.regions_of_plates, b, a);
}

struct StepOptions {
  float pull, damping;
  RotationEffort effort;
  bool cold;
};

/// Computes the motions of regions from their sums, in blocks that are small enough for a host's first-level cache and
/// long enough to overlap iterations.
/// @param motions  four slots for each of `groups`: those of the sums, or others
/// @param keep     is called for each group with its sum m~ x: keep(group, momentum)
/// @param worst    becomes the largest square of a rotation's residual in each lane
template <typename Keep>
inline void match_regions(const RegionConstants* regions, Quaternion4* rotations, const Slot* sums,
                          Slot* motions, uint32_t groups, vec_float4 noise_floor, const StepOptions& options,
                          const Keep& keep, vec_float4& worst) {
  constexpr uint32_t kBlock = 8;
  vec_uint4 indefinite[kBlock];
  for (uint32_t first = 0; first < groups; first += kBlock) {
    const uint32_t left = groups - first, count = left < kBlock ? left : kBlock;
    Slot* const slots = motions + 4 * first;

    for (uint32_t g = 0; g < count; ++g)
      make_problem(regions[first + g], sums + 4 * (first + g), slots + 4 * g, noise_floor);
    if (!options.cold)
      improve_rotations(problem_at(slots), rotations + first, indefinite, count, options.effort);
    for (uint32_t g = 0; g < count; ++g) {
      const RotationProblem& problem = *problem_at(slots + 4 * g);
      const Vector3x4 momentum = problem.payload;
      const Rotation4 found = options.cold ? find_rotation(problem, rotations[first + g])
                                           : rotation_of(problem, rotations[first + g], indefinite[g]);
      keep(first + g, momentum);
      store_motions(regions[first + g], found.matrix, momentum, slots + 4 * g);
      worst = spu_sel(worst, found.residual_square, negative_lanes(less(worst, found.residual_square)));
    }
  }
}

/// Changes velocities by the totals: v += pull (g - x), minus the velocity that this would give the body as a whole.
inline void pull_particles(const BodyMap& map, const Slot* totals, float pull) {
  const vec_float4 pull4 = spu_splats(pull), scale4 = spu_splats(map.hold.scale);
  PullSum pulls = no_pulls();
  for (uint32_t g = 0; g < map.particle_groups; ++g) {
    const ParticleConstants& p = map.particles[g];
    const Vector3x4 to_goal =
        difference(goals(p.rest_moment, p.inverse_mass, p.region, totals), map.positions[g].v);
    map.velocities[g].v = scale_add(to_goal, pull4, map.velocities[g].v);
    add_pulls(pulls, to_goal, spu_mul(p.mass, scale4));
  }
  const Vector3x4 drift = drift_of(pulls, pull * map.hold.share);
  for (uint32_t g = 0; g < map.particle_groups; ++g)
    map.velocities[g].v = difference(map.velocities[g].v, drift);
}

/// Steps one body.
/// @pre    positions and velocities are in components, positions relative to the body's origin; slot 0 of both buffers is zero
/// @return the largest square of a rotation's residual in each lane
inline vec_float4 step_body(const BodyMap& map, const StepOptions& options) {
  Slot *const a = map.first, *const b = map.second;

  const vec_float4 noise_floor = spu_splats(map.noise_floor);

  for (uint32_t g = 0; g < map.particle_groups; ++g)
    match_moments(map.particles[g].rest_moment, map.positions[g].v, a + 1 + 4 * g);
  sum_up(map, a, b);
  vec_float4 residual = spu_splats(0.0f);
  match_regions(
      map.regions, map.rotations, b + 1, b + 1, map.region_groups, noise_floor, options,
      [&](uint32_t g, const Vector3x4& momentum)
          __attribute__((always_inline)) { map.momenta[g] = momentum; },
      residual);
  sum_down<3>(map, b, a);
  pull_particles(map, a, options.pull);
  if (!(options.damping > 0)) return residual;

  for (uint32_t g = 0; g < map.particle_groups; ++g)
    twist_moments(modified_mass(map.particles[g].rest_moment), map.positions[g].v, map.velocities[g].v,
                  b + 1 + 4 * g);
  sum_up(map, b, a);
  for (uint32_t g = 0; g < map.region_groups; ++g)
    twist_regions(map.regions[g].inverse_mass, map.momenta[g], a + 1 + 4 * g, a + 1 + 4 * g, noise_floor);
  sum_down<2>(map, a, b);
  for (uint32_t g = 0; g < map.particle_groups; ++g) {
    const ParticleConstants& p = map.particles[g];
    const vec_float4 share = spu_mul(modified_mass(p.rest_moment), p.inverse_mass);
    map.velocities[g].v =
        damp(share, p.region, b, map.positions[g].v, map.velocities[g].v, spu_splats(options.damping));
  }
  return residual;
}

}  // namespace softcell::spu
