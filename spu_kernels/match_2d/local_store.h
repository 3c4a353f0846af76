#pragma once
// The layout of a plan and two bodies in the local store of the kernel `match_2d`.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "common/vector2.h"
#include "match_2d_job.h"
#include "rotation_2d.h"

namespace softcell::spu {

/// A payload. For matching: m~x, m~y, m~ x.x0, m~ x0 x x on the way from particles to regions; t, cos, sin on the way back.
struct Slot2d {
  vec_float4 row[1];
};
static_assert(sizeof(Slot2d) == kMatch2dSlotBytes, "as offsets count it");

/// MatchParticles2d as registers.
struct ParticleConstants2d {
  Vector2x4 rest;
  vec_float4 modified_mass, share, mass;
  uint32_t region[4];
};
static_assert(sizeof(ParticleConstants2d) == sizeof(MatchParticles2d), "the same bytes");

/// MatchRegions2d as registers.
struct RegionConstants2d {
  Vector2x4 centre;
  vec_float4 inverse_mass;
};
static_assert(sizeof(RegionConstants2d) == sizeof(MatchRegions2d), "the same bytes");
static_assert(sizeof(Direction4) == sizeof(MatchDirections), "the same bytes");

/// The data that all bodies of a model share. The pointers are computed at run time and never stored in static data.
struct PlanMap2d {
  const ParticleConstants2d* particles;
  const RegionConstants2d* regions;
  const uint16_t *bars_of_particles, *bars_of_regions, *regions_of_bars;
  uint32_t particle_groups, region_groups;
  float noise_floor, inverse_mass;  // of the plan's header

  Vector2x4* centres;      // of each region
  Slot2d *first, *second;  // the two buffers
};

/// The data of one body. They come from main memory as pairs of particles; localise.h turns these into components.
struct BodyMap2d {
  Vector2x4* positions;  // relative to the body's origin
  MatchResult2d* result;
  Vector2x4* velocities;
  Direction4* directions;
};

/// Two bodies: one is fetched while the other is stepped.
struct ArenaMap2d {
  PlanMap2d plan;
  BodyMap2d body[2];
};

/// @param arena  holds the plan already, and room for match_2d_local_store_bytes()
inline ArenaMap2d map_of_2d(char* arena) {
  const MatchPlanHeader2d& plan = *reinterpret_cast<const MatchPlanHeader2d*>(arena);
  const auto list = [&](uint32_t offset) { return reinterpret_cast<const uint16_t*>(arena + offset); };
  char* free = arena + plan.bytes;
  const auto take = [&](uint32_t bytes) {
    char* const part = free;
    free += bytes;
    return part;
  };
  ArenaMap2d map;
  for (BodyMap2d& body : map.body) {
    body.positions = reinterpret_cast<Vector2x4*>(take(match_2d_positions_stride(plan)));
    char* const state = take(match_2d_state_stride(plan));
    body.result = reinterpret_cast<MatchResult2d*>(state);
    body.velocities = reinterpret_cast<Vector2x4*>(state + sizeof(MatchResult2d));
    body.directions = reinterpret_cast<Direction4*>(state + match_2d_directions_at(plan));
  }
  map.plan.particles = reinterpret_cast<const ParticleConstants2d*>(arena + plan.particle_constants);
  map.plan.regions = reinterpret_cast<const RegionConstants2d*>(arena + plan.region_constants);
  map.plan.bars_of_particles = list(plan.bars_of_particles);
  map.plan.bars_of_regions = list(plan.bars_of_regions);
  map.plan.regions_of_bars = list(plan.regions_of_bars);
  map.plan.particle_groups = groups_of(plan.particles);
  map.plan.region_groups = groups_of(plan.regions);
  map.plan.noise_floor = plan.noise_floor;
  map.plan.inverse_mass = plan.inverse_mass;
  map.plan.centres = reinterpret_cast<Vector2x4*>(take(groups_of(plan.regions) * sizeof(Vector2x4)));
  map.plan.first = reinterpret_cast<Slot2d*>(take(plan.slots * kMatch2dSlotBytes));
  map.plan.second = reinterpret_cast<Slot2d*>(take(plan.slots * kMatch2dSlotBytes));
  return map;
}

}  // namespace softcell::spu
