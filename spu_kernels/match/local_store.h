#pragma once
// The layout of a plan and one body's state in the local store of the kernel `match`.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "common/matrix3.h"
#include "match_job.h"

namespace softcell::spu {

/// A payload: three rows of four words. For matching, row k is sum m~ x_k (x0 y0 z0 1) on the way from particles to regions, and row k of
/// (R | t) on the way back.
struct Slot {
  vec_float4 row[3];
};
static_assert(sizeof(Slot) == kMatchSlotBytes, "as offsets count it");

/// A payload of two rows: that of damping on the way from regions to particles, in `match_tiles`, which has slots for this purpose alone.
struct TwistSlot {
  vec_float4 row[2];
};
static_assert(sizeof(TwistSlot) == kTwistSlotBytes, "as offsets count it");

/// m~ (x0 y0 z0 1) of four particles.
using RestMoments = vec_float4[4];

/// MatchParticles as registers.
struct ParticleConstants {
  RestMoments rest_moment;
  vec_float4 inverse_mass, mass;
  uint32_t region[4];
};
static_assert(sizeof(ParticleConstants) == sizeof(MatchParticles), "the same bytes");

/// MatchRegions as registers.
struct RegionConstants {
  Vector3x4 centre;
  vec_float4 inverse_mass;
};
static_assert(sizeof(RegionConstants) == sizeof(MatchRegions), "the same bytes");

/// Positions or velocities of four particles. In main memory each quadword is a particle; localise.h transposes them, and then each
/// quadword is a component of all four.
struct Vectors4 {
  Vector3x4 v;
  vec_float4 spare;
};

/// The parts of the arena, one after the other. The pointers are computed at run time and never stored in static data.
struct BodyMap {
  const ParticleConstants* particles;
  const RegionConstants* regions;
  const uint16_t *bars_of_particles, *bars_of_regions, *plates, *regions_of_plates;
  uint32_t particle_groups, region_groups;
  float noise_floor;  // of the plan's header
  MatchHold hold;

  Vectors4* positions;  // relative to the body's origin
  MatchResult* result;  // result, velocities and rotations are the state, one after the other
  Vectors4* velocities;
  Quaternion4* rotations;
  Vector3x4* momenta;    // of each region: sum m~ x
  Slot *first, *second;  // the two buffers
};

/// @param arena  holds the plan already, and room for match_local_store_bytes()
inline BodyMap map_of(char* arena) {
  const MatchPlanHeader& plan = *reinterpret_cast<const MatchPlanHeader*>(arena);
  const auto list = [&](uint32_t offset) { return reinterpret_cast<const uint16_t*>(arena + offset); };
  char* free = arena + plan.bytes;
  const auto take = [&](uint32_t bytes) {
    char* const part = free;
    free += bytes;
    return part;
  };
  BodyMap map;
  map.particles = reinterpret_cast<const ParticleConstants*>(arena + plan.particle_constants);
  map.regions = reinterpret_cast<const RegionConstants*>(arena + plan.region_constants);
  map.bars_of_particles = list(plan.bars_of_particles);
  map.bars_of_regions = list(plan.bars_of_regions);
  map.plates = list(plan.plates);
  map.regions_of_plates = list(plan.regions_of_plates);
  map.noise_floor = plan.noise_floor;
  map.hold = plan.hold;
  map.particle_groups = groups_of(plan.particles);
  map.region_groups = groups_of(plan.regions);
  map.positions = reinterpret_cast<Vectors4*>(take(match_positions_stride(plan)));
  char* const state = take(match_state_stride(plan));
  map.result = reinterpret_cast<MatchResult*>(state);
  map.velocities = reinterpret_cast<Vectors4*>(state + sizeof(MatchResult));
  map.rotations = reinterpret_cast<Quaternion4*>(state + match_rotations_at(plan));
  map.momenta = reinterpret_cast<Vector3x4*>(take(match_momenta_bytes(plan)));
  map.first = reinterpret_cast<Slot*>(take(match_buffer_bytes(plan)));
  map.second = reinterpret_cast<Slot*>(take(match_buffer_bytes(plan)));
  return map;
}

}  // namespace softcell::spu
