#pragma once
// One body's step in local store: matching, then damping. Positions stay, velocities change.
//
//   first             second             (the two buffers, slot by slot)
//   particles   -->   bars
//   plates      <--
//               -->   regions: sums become motions in place
//   bars        <--
//               -->   plates
//   totals      <--                      goals, new velocities, momentum held
//               -->   particles          and the same way again for damping, buffers exchanged

#include "common/sums.h"
#include "match/damping.h"
#include "match/local_store.h"
#include "match/localise.h"
#include "match/matching.h"

namespace softcell::spu {

/// From particles in `a` to regions in `b`.
inline void sum_up(const BodyMap& map, Slot* a, Slot* b) {
  sum_slots<3>(map.bars_of_particles, a, b);
  sum_slots<3>(map.plates, b, a);
  sum_slots<3>(map.regions_of_plates, a, b);
}

/// From regions in `b` to the totals of each region's particles in `a`. Membership is symmetric, so the same
/// lists do, but for the first.
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

/// Sums to motions, in place, and the momenta. In blocks that are small enough for the first-level cache of a
/// host and long enough to overlap iterations.
/// @return the largest square of a rotation's residual in each lane
inline vec_float4 match_regions(const BodyMap& map, Slot* sums, const StepOptions& options) {
  constexpr uint32_t kBlock = 8;
  const vec_float4 noise_floor = spu_splats(map.noise_floor);
  vec_float4 worst = spu_splats(0.0f);
  for (uint32_t first = 0; first < map.region_groups; first += kBlock) {
    const uint32_t left = map.region_groups - first, count = left < kBlock ? left : kBlock;
    const RegionConstants* const regions = map.regions + first;
    Quaternion4* const rotations = map.rotations + first;
    Slot* const slots = sums + 1 + 4 * first;

    for (uint32_t g = 0; g < count; ++g) make_problem(regions[g], slots + 4 * g, noise_floor);
    if (!options.cold) improve_rotations(problem_at(slots), rotations, count, options.effort);
    for (uint32_t g = 0; g < count; ++g) {
      const RotationProblem& problem = *problem_at(slots + 4 * g);
      const Vector3x4 momentum = problem.payload;
      const Rotation4 found =
          options.cold ? find_rotation(problem, rotations[g]) : rotation_of(problem, rotations[g]);
      map.momenta[first + g] = momentum;
      store_motions(regions[g], found.matrix, momentum, slots + 4 * g);
      worst = spu_sel(worst, found.residual_square, negative_lanes(less(worst, found.residual_square)));
    }
  }
  return worst;
}

/// From sums of motions to velocities: v += pull (g - x).
/// @return  sum m (g - x) in each lane
inline Vector3x4 pull_particles(const BodyMap& map, const Slot* totals, vec_float4 pull) {
  const vec_float4 zero = spu_splats(0.0f);
  Vector3x4 moment = {zero, zero, zero};
  for (uint32_t g = 0; g < map.particle_groups; ++g) {
    const Vector3x4 to_goal = difference(goals(map.particles[g], totals), map.positions[g].v);
    map.velocities[g].v = scale_add(to_goal, pull, map.velocities[g].v);
    moment = scale_add(to_goal, map.particles[g].mass, moment);
  }
  return moment;
}

/// Takes off the velocities what the pull has given the body as a whole. It should be nothing and is a
/// rounding error; but truncation errs to one side, and a body at rest would begin to drift.
inline void hold_momentum(const BodyMap& map, const Vector3x4& moment, float pull) {
  const vec_float4 share = spu_splats(pull * map.inverse_mass);
  const Vector3x4 drift = {spu_mul(sum_of_lanes(moment.x), share), spu_mul(sum_of_lanes(moment.y), share),
                           spu_mul(sum_of_lanes(moment.z), share)};
  for (uint32_t g = 0; g < map.particle_groups; ++g)
    map.velocities[g].v = difference(map.velocities[g].v, drift);
}

/// @pre    positions and velocities in components, positions about the body's origin; both buffers' slot 0 is
///         zero
/// @return the largest square of a rotation's residual in each lane
inline vec_float4 step_body(const BodyMap& map, const StepOptions& options) {
  Slot *const a = map.first, *const b = map.second;

  for (uint32_t g = 0; g < map.particle_groups; ++g)
    match_moments(map.particles[g], map.positions[g].v, a + 1 + 4 * g);
  sum_up(map, a, b);
  const vec_float4 residual = match_regions(map, b, options);
  sum_down<3>(map, b, a);
  hold_momentum(map, pull_particles(map, a, spu_splats(options.pull)), options.pull);
  if (!(options.damping > 0)) return residual;

  for (uint32_t g = 0; g < map.particle_groups; ++g)
    twist_moments(map.particles[g], map.positions[g].v, map.velocities[g].v, b + 1 + 4 * g);
  sum_up(map, b, a);
  for (uint32_t g = 0; g < map.region_groups; ++g)
    twist_regions(map.regions[g], map.momenta[g], a + 1 + 4 * g, spu_splats(map.noise_floor));
  sum_down<2>(map, a, b);
  for (uint32_t g = 0; g < map.particle_groups; ++g)
    map.velocities[g].v =
        damp(map.particles[g], b, map.positions[g].v, map.velocities[g].v, spu_splats(options.damping));
  return residual;
}

}  // namespace softcell::spu
