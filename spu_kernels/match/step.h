#pragma once
// One body's step in local store: matching, then damping. Positions stay, velocities change.
//
//   first             second             (the two buffers, slot by slot)
//   particles   -->   bars
//   plates      <--
//               -->   regions: sums become motions in place
//   bars        <--
//               -->   plates
//   totals      <--                      goals, new velocities
//               -->   particles          and the same way again for damping, buffers exchanged

#include "match/damping.h"
#include "match/local_store.h"
#include "match/localise.h"
#include "match/matching.h"
#include "match/sums.h"

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
inline vec_float4 match_regions(const BodyMap& map, Slot* sums, vec_float4 noise_floor,
                                const StepOptions& options) {
  constexpr uint32_t kBlock = 8;
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

/// @pre    positions and velocities in components, positions about the body's origin; both buffers' slot 0 is
///         zero
/// @return the largest square of a rotation's residual in each lane
inline vec_float4 step_body(const BodyMap& map, float noise_floor, const StepOptions& options) {
  Slot *a = map.first, *b = map.second;
  const vec_float4 floor = spu_splats(noise_floor);

  for (uint32_t g = 0; g < map.particle_groups; ++g)
    match_moments(map.particles[g], map.positions[g].v, a + 1 + 4 * g);
  sum_up(map, a, b);
  const vec_float4 residual = match_regions(map, b, floor, options);
  sum_down<3>(map, b, a);

  const vec_float4 pull = spu_splats(options.pull);
  const bool damps = options.damping > 0;
  for (uint32_t g = 0; g < map.particle_groups; ++g) {
    const Vector3x4 x = map.positions[g].v;
    const Vector3x4 goal = goals(map.particles[g], a);
    const Vector3x4 v = scale_add({spu_sub(goal.x, x.x), spu_sub(goal.y, x.y), spu_sub(goal.z, x.z)}, pull,
                                  map.velocities[g].v);
    map.velocities[g].v = v;
    if (damps) twist_moments(map.particles[g], x, v, b + 1 + 4 * g);
  }
  if (!damps) return residual;

  sum_up(map, b, a);
  for (uint32_t g = 0; g < map.region_groups; ++g)
    twist_regions(map.regions[g], map.momenta[g], a + 1 + 4 * g, floor);
  sum_down<2>(map, a, b);
  const vec_float4 damping = spu_splats(options.damping);
  for (uint32_t g = 0; g < map.particle_groups; ++g)
    map.velocities[g].v = damp(map.particles[g], b, map.positions[g].v, map.velocities[g].v, damping);
  return residual;
}

}  // namespace softcell::spu
