#pragma once
// The layout of the local store of the kernel `match_tiles`: two slices, results, and the slots that continue from slice to slice.

#include "match/local_store.h"
#include "match_tiles_job.h"

namespace softcell::spu {

struct WeightConstants {
  vec_float4 inverse_mass, mass;
};
static_assert(sizeof(WeightConstants) == sizeof(TileWeights), "the same bytes");

/// TilePulled as registers.
struct Pulled4 {
  Vector3x4 x, v;
  vec_float4 modified_mass, share;
};
static_assert(sizeof(Pulled4) == sizeof(TilePulled), "the same bytes");

struct MomentumConstants {
  Vector3x4 momentum;  // sum m~ x
  vec_float4 inverse_mass;
};
static_assert(sizeof(MomentumConstants) == sizeof(TileMomenta), "the same bytes");

static_assert(sizeof(RestMoments) == sizeof(TileRest), "the same bytes");

/// One side of the double buffer, from particles to regions.
struct UpSide {
  char* lists;
  Vectors4* positions;         // gather
  RestMoments* rest;           // gather
  Pulled4* pulled;             // twist, in the place of positions and rest
  RegionConstants* regions;    // gather
  MomentumConstants* momenta;  // twist, in the place of regions
  Quaternion4* rotations;      // gather
};

/// One side of the double buffer, from regions to particles.
struct DownSide {
  char* lists;
  Vectors4* positions;       // scatter
  Vectors4* velocities;      // scatter
  RestMoments* rest;         // scatter
  WeightConstants* weights;  // scatter
  Pulled4* pulled;           // damp, in the place of positions and velocities
};

/// Allocates parts of the arena, one after the other.
class Arena {
 public:
  explicit Arena(char* begin) : free_(begin) {}

  template <typename T>
  T* take(uint32_t bytes) {
    T* const part = reinterpret_cast<T*>(free_);
    free_ += bytes;
    return part;
  }

 private:
  char* free_;
};

struct UpStore {
  TileSlice* slices;
  UpSide side[2];
  Slot* motions;  // out
  MomentumConstants* momenta;
  Slot* slots;
};

struct DownStore {
  TileSlice* slices;
  DownSide side[2];
  Pulled4* pulled;   // scatter: out
  Vectors4* damped;  // damp: out, in the same place
  Slot* slots;
};

inline UpStore up_store(char* arena, const TileLimits& limits) {
  Arena free(arena);
  UpStore store;
  store.slices = free.take<TileSlice>(limits.slices * static_cast<uint32_t>(sizeof(TileSlice)));
  for (UpSide& side : store.side) {
    side.lists = free.take<char>(limits.lists_bytes);
    side.positions = free.take<Vectors4>(64 * limits.input_groups);
    side.rest = free.take<RestMoments>(64 * limits.input_groups);
    side.pulled = reinterpret_cast<Pulled4*>(side.positions);
    side.regions = free.take<RegionConstants>(64 * limits.output_groups);
    side.momenta = reinterpret_cast<MomentumConstants*>(side.regions);
    side.rotations = free.take<Quaternion4>(64 * limits.output_groups);
  }
  store.motions = free.take<Slot>(4 * kMatchSlotBytes * limits.output_groups);
  store.momenta = free.take<MomentumConstants>(64 * limits.output_groups);
  store.slots = free.take<Slot>(0);
  return store;
}

inline DownStore down_store(char* arena, const TileLimits& limits) {
  Arena free(arena);
  DownStore store;
  store.slices = free.take<TileSlice>(limits.slices * static_cast<uint32_t>(sizeof(TileSlice)));
  for (DownSide& side : store.side) {
    side.lists = free.take<char>(limits.lists_bytes);
    side.positions = free.take<Vectors4>(64 * limits.output_groups);
    side.velocities = free.take<Vectors4>(64 * limits.output_groups);
    side.rest = free.take<RestMoments>(64 * limits.output_groups);
    side.weights = free.take<WeightConstants>(32 * limits.output_groups);
    side.pulled = reinterpret_cast<Pulled4*>(side.positions);
  }
  store.pulled = free.take<Pulled4>(static_cast<uint32_t>(sizeof(Pulled4)) * limits.output_groups);
  store.damped = reinterpret_cast<Vectors4*>(store.pulled);
  store.slots = free.take<Slot>(0);
  return store;
}

}  // namespace softcell::spu
